#!/usr/bin/env python3
"""Checks the Markdown documents of a Git checkout: `documents.py FOLDER`.

Reports, one per line as FILE:LINE: MESSAGE,
* relative links to a file or folder that Git does not know, and #anchors without a heading;
* `file:function` where the file does not exist or does not contain the function's name;
* paths in back quotes that begin with a folder of the repository and do not exist;
* tests of GoogleTest that do not exist: `Suite.Name`, the beginning of one with … behind it, and filters;
* documents below docs/ that no other document links;
* decisions whose first line names the decisions that supersede them, where their row in the index does not, and the reverse.
Exit code 1 when there is a fault. Decisions and the changelog are records: the paths in them may be old.
"""
import fnmatch
import pathlib
import re
import subprocess
import sys
import urllib.parse

LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\[\]]*\])*\]\(\s*<?([^()\s<>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
LINK_IN_LINK = re.compile(r"!\[[^\[\]]*\]\(([^()\s]+)\)")
HEADING = re.compile(r"^ {0,3}(#{1,6})\s+(.*?)\s*#*\s*$")
FENCE = re.compile(r"^ {0,3}(```+|~~~+)")
CODE = re.compile(r"(`+)(.+?)\1")
FUNCTION = re.compile(r"([\w.@/-]*\w\.(?:cpp|h|comp|glsl|proto|ts|mjs|py|sh)):((?:\w+::)*~?[A-Za-z_]\w*)")
PATH = re.compile(r"(?:\.ci|docker|docs|proto|server|shaders|tests|web-client)/[\w./-]*")
TEST = re.compile(r"\bTEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)")
TEST_NAME = re.compile(r"\b([A-Z]\w+)\.([A-Z]\w+)(…|\*)?")
TEST_FILTER = re.compile(r"gtest_filter=['\"]?([\w*./:-]+)")
PLACEHOLDER = re.compile(r"\b(?:NAME|TARGET|FILE|SUBJECT|VERB)\b")


def is_record(name):
    """Returns whether the document describes the past, so that its paths may be gone."""
    return name == "CHANGELOG.md" or name.startswith("docs/decisions/")


def anchor_of(heading):
    """Returns the anchor that GitHub gives a heading."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


class Checkout:
    """The files of a folder that Git does not ignore: committed and new ones."""

    def __init__(self, root):
        self.root = root
        listed = self.git("ls-files", "-z", "--cached", "--others", "--exclude-standard")
        self.files = {name for name in listed.split("\0") if name and (root / name).is_file()}
        self.tests = {pair for name in self.files if re.fullmatch(r"tests/.*\.cpp", name) for pair in TEST.findall(self.text(name))}
        self.folders = {str(parent) for name in self.files for parent in pathlib.PurePosixPath(name).parents}

    def git(self, *arguments):
        command = ["git", "-c", "safe.directory=*", "-C", str(self.root), *arguments]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout

    def has(self, name):
        return name in self.files or name in self.folders

    def is_ignored(self, name):
        command = ["git", "-c", "safe.directory=*", "-C", str(self.root), "check-ignore", "--quiet", "--no-index", name]
        return subprocess.run(command, check=False).returncode == 0

    def text(self, name):
        return (self.root / name).read_text(encoding="utf-8")

    def matches(self, name):
        """Returns the files that `name` can mean: a path from the root, or the end of one."""
        return [name] if name in self.files else [known for known in self.files if known.endswith("/" + name)]


class Document:
    """One Markdown file: its lines, its links with their line numbers, and its anchors."""

    def __init__(self, name, text):
        self.name = name
        self.lines = text.splitlines()
        self.anchors = set()
        prose = []  # the same lines, empty inside fenced code, without code in back quotes
        fence = None
        for line in self.lines:
            mark = FENCE.match(line)
            if mark and (fence is None or mark.group(1).startswith(fence)):
                fence = mark.group(1) if fence is None else None
                prose.append("")
                continue
            prose.append("" if fence else CODE.sub(lambda code: "`" * len(code.group(0)), line))
            heading = None if fence else HEADING.match(line)
            if heading:
                self._add_anchor(anchor_of(heading.group(2)))
            if not fence:
                self.anchors.update(re.findall(r"<a (?:id|name)=\"([^\"]+)\"", line))
        text = "\n".join(prose)  # a link's text may continue on the next line
        found = [*LINK.finditer(text), *LINK_IN_LINK.finditer(text)]
        self.links = dict.fromkeys((text.count("\n", 0, link.start(1)) + 1, link.group(1)) for link in found)

    def _add_anchor(self, anchor):
        unique, number = anchor, 0
        while unique in self.anchors:
            number += 1
            unique = f"{anchor}-{number}"
        self.anchors.add(unique)


def check_link(checkout, documents, document, target, linked):
    """Returns what is wrong with a link, or None; adds the document that it leads to to `linked`."""
    if re.match(r"[a-zA-Z][a-zA-Z0-9+.-]*:", target):
        return None
    path, _, anchor = target.partition("#")
    name = document.name
    if path:
        start = pathlib.PurePosixPath(document.name).parent
        try:
            found = (checkout.root / start / urllib.parse.unquote(path)).resolve().relative_to(checkout.root)
        except ValueError:
            return f"link {target} leads out of the repository"
        name = found.as_posix()
        if not checkout.has(name):
            return f"link {target}: there is no {name}"
    if name != document.name:
        linked.add(name)
    if anchor and name in documents and anchor not in documents[name].anchors:
        return f"link {target}: {name} has no heading #{anchor}"
    return None


def check_function(checkout, name, function):
    """Returns what is wrong with a `file:function`, or None."""
    files = checkout.matches(name)
    if not files:
        return f"{name}:{function}: there is no such file"
    words = [set(re.findall(r"\w+", checkout.text(file))) for file in files]
    if not any(all(part.lstrip("~") in known for part in function.split("::")) for known in words):
        return f"{name}:{function}: {' and '.join(sorted(files))} does not contain that name"
    return None


def check_tests(checkout, line):
    """Yields what is wrong with the tests that a line names."""
    suites = {suite for suite, _ in checkout.tests}
    for suite, test, more in TEST_NAME.findall(TEST_FILTER.sub("", line)):
        if suite in suites and not any(known == test or more and known.startswith(test) for of, known in checkout.tests if of == suite):
            yield f"there is no test {suite}.{test}{more}"
    if not checkout.tests:
        return
    names = [name for pair in checkout.tests for name in (".".join(pair), f"PREFIX/{'.'.join(pair)}/SCENE")]
    for pattern in (one for found in TEST_FILTER.findall(line) for one in found.split(":")):
        if not fnmatch.filter(names, pattern):
            yield f"no test matches {pattern}"


def check_superseded(documents):
    """Yields the decisions whose page and row in the index name different successors."""
    index = documents.get("docs/decisions/README.md")
    for row in index.lines if index else ():
        if not (page := re.match(r"\| \[(\d+)\]\(([\w.-]+)\)", row)) or f"docs/decisions/{page[2]}" not in documents:
            continue
        text = "\n".join(documents[f"docs/decisions/{page[2]}"].lines)
        first = re.search(r"\A#[^\n]*\n\nSuperseded[^:]*", text)
        above = re.findall(r"\[(\d+)\]", first[0]) if first else []
        said = re.search(r"uperseded by ([\d, and]+)", row)
        if sorted(above) != sorted(re.findall(r"\d+", said[1]) if said else []):
            yield f"docs/decisions/{page[2]}:1: the index names other decisions that supersede it"


def faults(root):
    """Returns every fault, by file and line, and the number of documents."""
    checkout = Checkout(root)
    names = sorted(name for name in checkout.files if name.endswith(".md"))
    documents = {name: Document(name, checkout.text(name)) for name in names}
    linked = set()
    out = []
    for document in documents.values():
        found = [(number, check_link(checkout, documents, document, target, linked)) for number, target in document.links]
        for number, line in enumerate(document.lines, start=1):
            found += [(number, check_function(checkout, *match)) for match in FUNCTION.findall(line)]
            found += [(number, fault) for fault in check_tests(checkout, line)]
            if not is_record(document.name):
                for _, code in CODE.findall(line):
                    path = code.rstrip("/")
                    if not PATH.fullmatch(code) or PLACEHOLDER.search(code) or checkout.has(path):
                        continue
                    if not checkout.is_ignored(path):
                        found.append((number, f"`{code}` does not exist"))
        found.sort(key=lambda entry: entry[0])
        out += [f"{document.name}:{number}: {fault}" for number, fault in found if fault]
    out += [f"{name}:1: no other document links it" for name in names if name.startswith("docs/") and name not in linked]
    out += check_superseded(documents)
    return out, len(names)


def main():
    if len(sys.argv) != 2:
        print("usage: documents.py FOLDER", file=sys.stderr)
        return 2
    found, count = faults(pathlib.Path(sys.argv[1]).resolve())
    for fault in found:
        print(fault)
    print(f"{count} documents, {len(found)} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
