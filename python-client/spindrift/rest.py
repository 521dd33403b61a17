"""Requests to a server beside the connection."""
from __future__ import annotations

import json
import urllib.error
import urllib.request

from .errors import ConnectionLost, SpindriftError


def fetch(url: str, token: str) -> bytes:
    """GET. Raises SpindriftError with the server's reason, and ConnectionLost without an answer."""
    request = urllib.request.Request(url, headers={"Authorization": f"Bearer {token}"} if token else {})
    try:
        with urllib.request.urlopen(request, timeout=30) as answer:
            return answer.read()
    except urllib.error.HTTPError as error:
        raise SpindriftError(f"{url}: HTTP {error.code}: {_problem(error.read())}") from error
    except urllib.error.URLError as error:
        raise ConnectionLost(f"{url}: {error.reason}") from error


def _problem(body):
    try:
        return json.loads(body)["message"]
    except (ValueError, KeyError, TypeError):
        return body.decode(errors="replace").strip()
