#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of a build folder with CTest, and counts those that passed, failed and were skipped.

    tools/run_tests.py build/release -j 2
    tools/run_tests.py build/release -L unit

What follows the folder goes to ctest. Tests with the label `timing` wait for other programs, or measure time, and depend on what
else the machine does: those of them that fail run once more, one after another, after all others. No other test has a second chance,
and what passes at the second one is named. A skipped test is one that ended with its code or its text for that; one whose program or
fixture is missing has failed. Results stay in FOLDER/Testing: tests.log, and JUnit files
first.xml and again.xml.

The last line is "N passed, N failed, N skipped"; the exit code is 1 if a test failed, and 2 if none ran.
"""
import json
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

LABEL = "timing"
SKIPPED = ("SKIP_RETURN_CODE", "SKIP_REGULAR_EXPRESSION")  # how CTest begins the reason of a test that skipped itself
LINES, TESTS = 60, 20  # of output of a failed test, and failed tests whose output is shown


class Result:
    """One test of a JUnit file of CTest."""

    def __init__(self, case):
        reason = case.find("skipped")
        self.name, self.seconds = case.get("name"), float(case.get("time"))
        self.reason = "" if reason is None else reason.get("message", "")
        self.output = (case.findtext("system-out") or "").rstrip()
        status = case.get("status")
        asked = status == "disabled" or status == "notrun" and self.reason.startswith(SKIPPED)
        self.verdict = "skipped" if asked else "passed" if status == "run" else "failed"


def read(file):
    return {r.name: r for r in map(Result, ElementTree.parse(file).getroot().iter("testcase"))}


def ctest(folder, file, options, out):
    """Results of one run, empty if CTest could not start."""
    file.unlink(missing_ok=True)
    subprocess.run(["ctest", "--test-dir", str(folder), "--no-tests=error", "--output-junit", str(file), *options],
                   stdout=out, stderr=subprocess.STDOUT, check=False)
    return read(file) if file.exists() else {}


def labelled(folder, label):
    """Names of the tests with a label."""
    listed = subprocess.run(["ctest", "--test-dir", str(folder), "--show-only=json-v1"], stdout=subprocess.PIPE, check=True)
    return {test["name"] for test in json.loads(listed.stdout)["tests"]
            for p in test.get("properties", []) if p["name"] == "LABELS" and label in p["value"]}


def run(folder, options, out):
    """Final results of all tests, and the names of those that needed their second chance."""
    results = ctest(folder, folder / "Testing/first.xml", options, out)
    failed = [r.name for r in results.values() if r.verdict == "failed"]
    names = sorted(set(failed) & labelled(folder, LABEL)) if failed else []
    if not names:
        return results, []
    only = "^(" + "|".join(map(re.escape, names)) + ")$"
    again = ctest(folder, folder / "Testing/again.xml", ["-R", only, "--output-on-failure"], out)
    # A fixture that the repeated tests need runs with them; its result is the first one.
    results.update({name: again[name] for name in names if name in again})
    return results, [name for name in names if results[name].verdict == "passed"]


def why(result):
    """What a skipped test said: the line below ": Skipped" of GoogleTest, or its own line "skipped: ..."."""
    said = re.search(r": Skipped\n(.+)|^skipped: (.+)", result.output, re.M)
    return f"{result.name}: {said[1] or said[2]}" if said else result.name


def report(results, second):
    of = {verdict: [r for r in results.values() if r.verdict == verdict] for verdict in ("passed", "failed", "skipped")}
    for r in of["skipped"]:
        print(f"skipped: {why(r)}")
    for name in second:
        print(f"second chance used: {name}")
    for r in of["failed"][:TESTS]:
        print(f"failed: {r.name} ({r.seconds:.1f} s) {r.reason}".rstrip())
        for line in r.output.splitlines()[-LINES:]:
            print("    " + line)
    for r in of["failed"][TESTS:]:
        print(f"failed: {r.name}")
    print(", ".join(f"{len(tests)} {verdict}" for verdict, tests in of.items()))
    return 1 if of["failed"] else 0


def main(words):
    if not words or words[0].startswith("-"):
        print(__doc__)
        return 2
    folder = pathlib.Path(words[0]).resolve()
    if not (folder / "CTestTestfile.cmake").exists():
        print(f"{words[0]}: is no build folder with tests. Build there first.")
        return 2
    (folder / "Testing").mkdir(exist_ok=True)
    log = folder / "Testing/tests.log"
    with open(log, "w") as out:
        results, second = run(folder, words[1:], out)
    if not results:
        print(log.read_text()[-4000:] + f"\n{words[0]}: no test ran.")
        return 2
    return report(results, second)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
