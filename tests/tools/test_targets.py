#!/usr/bin/env python3
"""Prints the C++ test programs that contain the tests which match a regular expression, one per line.

    test_targets.py REGEX [FOLDER]

REGEX is searched in "LABEL/Suite.Test", as `ctest -R` does with names of tests; FOLDER is tests/. The names are read from
the sources, so that nothing has to be built. Exit code 1 if no test matches.
"""

import pathlib
import re
import sys

PROGRAM = re.compile(r"spindrift_test\(([^)]*)\)")
TEST = re.compile(r"^\s*TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
KEYWORDS = {"NAME", "LABEL", "TIMEOUT", "SOURCES", "LIBRARIES", "THREADS", "MEMORY", "APART", "EACH"}


def programs(folder):
    """Returns (name, label, sources) of every spindrift_test(...) below the folder."""
    for lists in sorted(folder.rglob("CMakeLists.txt")):
        for match in PROGRAM.finditer(re.sub(r"\$\{\w+\}", "", lists.read_text(encoding="utf-8"))):
            words = match.group(1).split()
            values, key = {}, ""
            for word in words:
                if word in KEYWORDS:
                    key = word
                else:
                    values.setdefault(key, []).append(word)
            if "NAME" in values:
                sources = [lists.parent / source for source in values.get("SOURCES", [])]
                yield values["NAME"][0], values.get("LABEL", [""])[0], sources


def targets(pattern, folder):
    for name, label, sources in programs(folder):
        tests = (f"{label}/{suite}.{test}" for source in sources if source.is_file()
                 for suite, test in TEST.findall(source.read_text(encoding="utf-8")))
        if any(pattern.search(test) for test in tests):
            yield name


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    folder = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else pathlib.Path(__file__).resolve().parents[1]
    try:
        pattern = re.compile(sys.argv[1])
    except re.error as error:
        print(f"{sys.argv[1]}: no regular expression: {error}", file=sys.stderr)
        return 2
    found = list(targets(pattern, folder))
    print("\n".join(found))
    return 0 if found else 1


if __name__ == "__main__":
    sys.exit(main())
