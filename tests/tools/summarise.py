#!/usr/bin/env python3
"""Adds up the JUnit reports of the parts of `./dev test`.

usage: summarise.py NAME:EXIT_CODE:FILE...

Prints one line per part, the failed tests with the head of their output, the skipped tests with the reason, and last
`N passed, N failed, N skipped`. Exit code 1 when anything failed.

A part that fails without naming a failed test counts as one failure, and so does a part without a report or without a
single test. A case of CTest whose output is GoogleTest's stands for the tests of a suite: each is counted and named. CTest calls
a test whose program is missing "notrun": it failed.
"""

import re
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

OUTPUT_LINES_SHOWN = 25
SUITE = re.compile(r"^\[==========\] Running (\d+) tests?", re.MULTILINE)
RESULT = re.compile(r"\[ *(OK|FAILED|SKIPPED) *\] (\w[\w/]*\.[\w/]+)(?:,.*)? \(\d+ ms\)")
STARTED = re.compile(r"\[ RUN      \] (\S+)")


@dataclass
class Part:
    name: str
    passed: int = 0
    failures: list = field(default_factory=list)  # (test, output)
    skips: list = field(default_factory=list)  # (test, reason)


def text_of(case, tag):
    element = case.find(tag)
    if element is None:
        return ""
    return "\n".join(filter(None, (element.get("message", "").strip(), (element.text or "").strip())))


def skip_reason(text):
    """GoogleTest prints the reason on the line after "...: Skipped"."""
    found = re.search(r": Skipped\n(.*)", text)
    return found.group(1).strip() if found else "no reason given"


def read_suite(part, label, text, has_failed):
    """Counts the tests of a run of GoogleTest. A test that began and did not end crashed, or was ended."""
    begins = [*STARTED.finditer(text)]
    ends = [begin.start() for begin in begins[1:]] + [len(text)]
    fine = len(part.failures)
    for begin, end in zip(begins, ends):
        name, output = label + begin.group(1), text[begin.end():end]
        result = RESULT.search(output)
        if result is None or result.group(2) != begin.group(1):
            part.failures.append((name, "did not end\n" + output))
        elif result.group(1) == "OK":
            part.passed += 1
        elif result.group(1) == "SKIPPED":
            part.skips.append((name, skip_reason(output)))
        else:
            part.failures.append((name, output))
    missing = int(SUITE.search(text).group(1)) - len(begins)
    if missing != 0 or (has_failed and len(part.failures) == fine):
        part.failures.append((label, f"{missing} tests did not run\n" + text[-1000:]))


def read_case(part, case):
    group = case.get("classname", "")
    name = case.get("name", "?")
    if group and group not in (name, "test"):
        name = f"{group} > {name}"
    skipped = case.find("skipped")
    text = text_of(case, "system-out")
    has_failed = case.find("failure") is not None or case.find("error") is not None or case.get("status") == "fail"
    if SUITE.search(text):
        read_suite(part, name[: name.index("/") + 1], text, has_failed)
    elif has_failed:
        output = "\n".join(filter(None, (text_of(case, tag) for tag in ("failure", "error", "system-out", "system-err"))))
        part.failures.append((name, output))
    elif case.get("status") == "notrun":
        part.failures.append((name, "did not run: " + (text_of(case, "skipped") or "no reason given")))
    elif case.get("status") == "disabled":
        part.skips.append((name, "disabled"))
    elif skipped is not None:
        message = skipped.get("message") or ""
        part.skips.append((name, "no reason given" if message in ("", "true") else message))
    else:
        part.passed += 1


def read_part(argument):
    name, code, path = argument.split(":", 2)
    part = Part(name)
    try:
        for case in ElementTree.parse(Path(path)).iter("testcase"):
            read_case(part, case)
    except FileNotFoundError:
        part.failures.append((name, f"wrote no report and ended with exit code {code}; see build/logs/test-{name}.log"))
        return part
    except ElementTree.ParseError as error:
        part.failures.append((name, f"wrote a broken report ({error}) and ended with exit code {code}"))
        return part
    if part.passed + len(part.failures) + len(part.skips) == 0:
        part.failures.append((name, f"ran no test at all (exit code {code})"))
    elif int(code) != 0 and not part.failures:
        part.failures.append((name, f"ended with exit code {code} although no test failed; see build/logs/test-{name}.log"))
    return part


def main(arguments):
    if not arguments or any(argument.count(":") < 2 for argument in arguments):
        print(__doc__, file=sys.stderr)
        return 2
    parts = [read_part(argument) for argument in arguments]

    for part in parts:
        for name, output in part.failures:
            print(f"FAILED {part.name}: {name}")
            lines = output.splitlines()
            for line in lines[:OUTPUT_LINES_SHOWN]:
                print(f"    {line}")
            if len(lines) > OUTPUT_LINES_SHOWN:
                print(f"    ... {len(lines) - OUTPUT_LINES_SHOWN} more lines in build/logs/test-{part.name}.log")
    for part in parts:
        reasons = {}
        for name, reason in part.skips:
            reasons.setdefault(reason, []).append(name)
        for reason, names in reasons.items():
            shown = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
            print(f"skipped {part.name}: {shown} ({reason})")
    for part in parts:
        print(f"{part.name}: {part.passed} passed, {len(part.failures)} failed, {len(part.skips)} skipped")

    failed = sum(len(part.failures) for part in parts)
    print(f"{sum(part.passed for part in parts)} passed, {failed} failed, {sum(len(part.skips) for part in parts)} skipped")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
