#!/usr/bin/env python3
"""Adds up the JUnit reports of the parts of `./dev test`.

usage: summarise.py NAME:EXIT_CODE:FILE...

Prints one line per part, the failed tests with the head of their output, the skipped tests with the reason, and last
`N passed, N failed, N skipped`. Exit code 1 when anything failed.

A part that fails without naming a failed test counts as one failure, and so does a part without a report or without a
single test. CTest calls two things "notrun": a test that skipped itself and a test whose program
is missing; only the first is a skip.
"""

import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

OUTPUT_LINES_SHOWN = 25
SKIP_MARKS = ("SKIP_REGULAR_EXPRESSION_MATCHED", "SKIP_RETURN_CODE")


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


def skip_reason(case):
    """GoogleTest prints the reason on the line after "...: Skipped"; others put it into the message."""
    lines = [line.strip() for line in text_of(case, "system-out").splitlines()]
    for index, line in enumerate(lines[:-1]):
        if line.endswith(": Skipped"):
            return lines[index + 1]
    message = (case.find("skipped").get("message") if case.find("skipped") is not None else "") or ""
    return "no reason given" if message in ("", "true") or message.startswith(SKIP_MARKS) else message


def read_case(part, case):
    group = case.get("classname", "")
    name = case.get("name", "?")
    if group and group not in (name, "test"):
        name = f"{group} > {name}"
    skipped = case.find("skipped")
    if case.find("failure") is not None or case.find("error") is not None or case.get("status") == "fail":
        output = "\n".join(filter(None, (text_of(case, tag) for tag in ("failure", "error", "system-out", "system-err"))))
        part.failures.append((name, output))
    elif case.get("status") == "notrun" and not (skipped is not None and skipped.get("message", "").startswith(SKIP_MARKS)):
        part.failures.append((name, "did not run: " + (text_of(case, "skipped") or "no reason given")))
    elif case.get("status") == "disabled":
        part.skips.append((name, "disabled"))
    elif skipped is not None:
        part.skips.append((name, skip_reason(case)))
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
