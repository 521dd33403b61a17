#!/usr/bin/env python3
"""Checks the language of a Git checkout: `words.py FOLDER`.

Reports words that readers of English as a second language misread, each with what to write instead, and lines of prose beyond
140 columns, one per line as FILE:LINE: MESSAGE. Exit code 1 when there is one. Decisions and the changelog are records: their
words stay.
"""
import pathlib
import re
import subprocess
import sys

PROSE_MAX_COLUMNS = 140
THINGS = "address|boolean|bus|folder|integer|key|line|name|number|option|path|port|room|row|scene|token|URL|value|word"
WORDS = [
    (rf"\b(?:is|are) no (?:{THINGS})s?\b", "'is not a ...', or 'is invalid'"),
    (r"\b(?:is|are) none of (?:its|our|the|them|these|those)\b", "'is not one of ...'"),
    (r"\b(?:is|are) none (?:that|to|without)\b", "'there is no ...', or what is left out"),
    (r"\bas many as (?:may|one \w+ may)\b", "'limit', 'the limit is reached'"),
    (r"\b(?:go|goes|gone|went) on\b(?! I/O)", "'continue', 'resume'"),
    (r"\bwhom\b", "the noun that is meant: 'the clients that ...', 'the person that ...'"),
    (r"\bwhat holds\b", "the subject"),
    (r"\b(?:commands|messages|frames|bytes|substeps?|steps|iterations|ms|once|twice) an? (?:second|minute|tick|substep|frame)\b", "'per'"),
    (r"\b(?:at|around|beside) (?:a|an?other|each|every|this) place\b|\bfunction of place\b", "'position'"),
    (r"\b(?:a|no) free place\b|\bplaces for (?:boats|effects)\b", "'slot', or the limit that is meant"),
    (r"\b(?:the )?most there can be\b", "'the limit of ... is reached'"),
    (r"\bstands? twice\b", "'is given twice'"),
]
PATTERNS = [(re.compile(rf"(?<!there )(?:{pattern})", re.IGNORECASE), advice) for pattern, advice in WORDS]
TEXTS = (".md", ".cpp", ".h", ".comp", ".glsl", ".proto", ".py", ".sh", ".ts", ".mjs", ".textproto")
# The first word of a comment of a declaration: a verb, or a noun that names the thing.
RIDDLE = re.compile(r"^\s*/// (Of|Whether|What|Where|Who|Which|How)\b")
HEADER = re.compile(r"server/.*\.h")
RECORDS = ("CHANGELOG.md", "docs/decisions/")
ITSELF = ("tests/tools/words.py", "tests/tools/words.test.mjs")


def tracked(root):
    command = ["git", "-c", "safe.directory=*", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\0")
    return sorted(name for name in names if name.endswith(TEXTS) and name not in ITSELF and (root / name).is_file())


def is_prose(line):
    """Whether a line of Markdown outside fenced code can be wrapped: no table, no indented code, not one long link."""
    return not line.startswith("    ") and not line.lstrip().startswith("|") and len(re.sub(r"\[[^\]]*\]\([^)]*\)|`[^`]*`", "", line)) > 0.4 * len(line)


def faults_of(name, text):
    fenced = False
    comment = False  # whether the line before belongs to the same comment
    for number, line in enumerate(text.splitlines(), start=1):
        if not name.startswith(RECORDS):
            for pattern, advice in PATTERNS:
                if found := pattern.search(line):
                    yield f"{name}:{number}: '{found[0]}': write {advice}"
        if HEADER.fullmatch(name):
            if not comment and (found := RIDDLE.match(line)):
                yield f"{name}:{number}: '{found[1]}' begins a comment: write 'Returns ...', or what the thing is"
            comment = line.lstrip().startswith("///")
        fenced ^= line.lstrip().startswith("```")
        if name.endswith(".md") and not fenced and len(line) > PROSE_MAX_COLUMNS and is_prose(line):
            yield f"{name}:{number}: {len(line)} columns of prose: wrap at {PROSE_MAX_COLUMNS}"


def main():
    if len(sys.argv) != 2:
        print("usage: words.py FOLDER", file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1]).resolve()
    faults = [fault for name in tracked(root) for fault in faults_of(name, (root / name).read_text(encoding="utf-8"))]
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
