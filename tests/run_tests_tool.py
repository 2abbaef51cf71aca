#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks tools/run_tests.py with CTest itself: what it counts, what has a second chance, and what it says."""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROJECT = r"""cmake_minimum_required(VERSION 3.25)
project(made NONE)
enable_testing()
# Passes at its second try.
function(flicker name labels)
  add_test(NAME ${name} COMMAND sh -c "test -e ${name} || { touch ${name}; echo ${name} tried once; false; }")
  set_tests_properties(${name} PROPERTIES LABELS "${labels}")
endfunction()
add_test(NAME good COMMAND true)
flicker(waits "unit;timing")
flicker(wai.ts timing)
if(FAILING)
  flicker(flickers unit)
  add_test(NAME never COMMAND false)
  set_tests_properties(never PROPERTIES LABELS timing)
  add_test(NAME missing COMMAND there_is_no_such_program)
  add_test(NAME hangs COMMAND sleep 20)
  set_tests_properties(hangs PROPERTIES TIMEOUT 1)
  add_test(NAME prepare COMMAND false)
  set_tests_properties(prepare PROPERTIES FIXTURES_SETUP prepared)
  add_test(NAME unprepared COMMAND true)
  set_tests_properties(unprepared PROPERTIES FIXTURES_REQUIRED prepared)
endif()
add_test(NAME by_code COMMAND sh -c "echo 'skipped: no meshio here'; exit 77")
set_tests_properties(by_code PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME by_text COMMAND sh -c "printf 'a_test.cpp:7: Skipped\nno device\n\n[  SKIPPED ] A.B (0 ms)\n'")
set_tests_properties(by_text PROPERTIES SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
add_test(NAME off COMMAND false)
set_tests_properties(off PROPERTIES DISABLED ON)
"""


def run(folder, *words):
    done = subprocess.run([sys.executable, str(ROOT / "tools/run_tests.py"), folder, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


with tempfile.TemporaryDirectory() as work:
    pathlib.Path(work, "CMakeLists.txt").write_text(PROJECT)
    for failing in ("OFF", "ON"):
        build = f"{work}/{failing}"
        subprocess.run(["cmake", "-S", work, "-B", build, f"-DFAILING={failing}"], stdout=subprocess.DEVNULL, check=True)
    code, text = run(f"{work}/OFF", "-j", "2")
    lines = text.splitlines()
    assert code == 0 and lines[-1] == "3 passed, 0 failed, 3 skipped", text
    assert lines[:-1] == ["skipped: by_code: no meshio here", "skipped: by_text: no device", "skipped: off",
                          "second chance used: wai.ts", "second chance used: waits"], text
    # Nobody needs a second chance now.
    assert run(f"{work}/OFF")[1].splitlines()[3:] == ["3 passed, 0 failed, 3 skipped"]
    assert run(f"{work}/OFF", "-R", "good") == (0, "1 passed, 0 failed, 0 skipped\n")

    # A test without the label has one try, one with it two; a program or a fixture that is missing is no reason to skip.
    code, text = run(f"{work}/ON")
    assert code == 1 and text.splitlines()[-1] == "3 passed, 6 failed, 3 skipped", text
    assert sorted(re.findall(r"^failed: (\S+)", text, re.M)) == ["flickers", "hangs", "missing", "never", "prepare", "unprepared"], text
    assert re.findall(r"^second chance used: (\S+)", text, re.M) == ["wai.ts", "waits"], text
    assert "    flickers tried once" in text, text

    code, text = run(f"{work}/ON", "-R", "there_is_none")
    assert code == 2 and "no test ran" in text, text
    code, text = run(work)
    assert code == 2 and "Build there first" in text, text

# Every name of the list of tests that depend on time is that of a test.
listed = re.search(r"set\(polhode_timing_tests\s+(.*?)\)", (ROOT / "tests/CMakeLists.txt").read_text(), re.S)[1].split()
sources = "".join(path.read_text() for path in (ROOT / "tests").rglob("*_test.cpp"))
there = {f"{suite}.{name}" for suite, name in re.findall(r"^TEST(?:_F)?\((\w+), (\w+)\)", sources, re.M)}
assert listed and set(listed) <= there, set(listed) - there
print(f"counts, second chances and {len(listed)} names are right")
