#!/usr/bin/env python3
"""Runs clang-tidy over C++ files, several at a time, and reports each file's findings.

usage: tidy.py BUILD_FOLDER REPORT.xml FILE...

Prints the findings of a file when it is done, and last `N files, N with findings`. Writes a JUnit report with one test
per file. Exit code 1 when a file has findings or clang-tidy failed on it.
"""

import concurrent.futures
import os
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree


def check(build, path):
    """Returns the path, the findings ('' for none) and the seconds."""
    begin = time.monotonic()
    run = subprocess.run(["clang-tidy", "--quiet", "-p", build, path], capture_output=True, text=True, check=False)
    # Standard error holds counts of suppressed warnings, and the reason if clang-tidy itself failed.
    findings = run.stdout.strip() or (run.stderr.strip() if run.returncode != 0 else "")
    if run.returncode != 0 and not findings:
        findings = f"clang-tidy ended with exit code {run.returncode}"
    return path, findings, time.monotonic() - begin


def main(arguments):
    if len(arguments) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    build, report, *paths = arguments
    suite = ElementTree.Element("testsuite", name="tidy", tests=str(len(paths)))
    bad_count = 0
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for done in concurrent.futures.as_completed([pool.submit(check, build, path) for path in paths]):
            path, findings, seconds = done.result()
            case = ElementTree.SubElement(suite, "testcase", name=path, time=f"{seconds:.1f}")
            if not findings:
                continue
            bad_count += 1
            print(findings, flush=True)
            ElementTree.SubElement(case, "failure", message="findings").text = findings
    ElementTree.ElementTree(suite).write(report)
    print(f"{len(paths)} files, {bad_count} with findings")
    return 1 if bad_count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
