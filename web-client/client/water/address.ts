// Addresses: what people type or copy from the page, and what sockets and requests need.

export interface Address {
  /** ws or wss, with the room if there is one. */
  socket: string;
  token: string;
}

/** Takes "host:port", http, https, ws and wss addresses, and the page's own ("http://host:8080/?room=b#token=t"). `room` and `token` come
 *  before those of the address. Throws a TypeError. */
export function parseAddress(text: string, room = "", token = ""): Address {
  const url = urlOf(/^\w+:\/\//.test(text) ? text : `http://${text}`);
  const scheme = url && { "http:": "ws:", "ws:": "ws:", "https:": "wss:", "wss:": "wss:" }[url.protocol];
  if (!url || !scheme || !url.hostname) throw new TypeError(`${JSON.stringify(text)} is not the address of a server, which looks like http://host:8080 or wss://host`);
  const [, path = "", named = ""] = /^(.*?)(?:\/ws(?:\/([^/]*))?)?\/?$/.exec(url.pathname.replace(/\/[^/]*\.html$/, "")) ?? [];
  const wanted = room || (url.searchParams.get("room") ?? decodeURIComponent(named));
  const kept = new URLSearchParams(url.hash.slice(1)).get("token") ?? "";
  return { socket: `${scheme}//${url.host}${path}/ws${wanted ? `/${encodeURIComponent(wanted)}` : ""}`, token: token || kept };
}

/** Returns the address of requests to the server of a socket, with a slash at its end. */
export function restBase(socketUrl: string): string {
  return socketUrl.replace(/^ws/, "http").replace(/\/ws(\/[^/]*)?$/, "/");
}

function urlOf(text: string): URL | undefined {
  try {
    return new URL(text);
  } catch {
    return undefined;
  }
}
