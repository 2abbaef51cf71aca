#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""All sources are read by clang without a warning; the tests build with g++.

    tools/check_clang.py BUILD    BUILD: a configured build folder, with its compile_commands.json

Nothing is compiled to code, so it takes a fraction of a build. Precompiled headers of g++ are left out.
"""
import concurrent.futures
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

# Options of g++ that clang does not know, or that only serve its precompiled headers.
LEFT_OUT = ("-fpch-preprocess", "-Winvalid-pch", "-Wno-use-after-free", "-Wno-restrict", "-Wno-array-bounds",
            "-Wno-maybe-uninitialized", "-Wno-stringop-overflow", "-Wno-subobject-linkage", "-c")


def command(entry):
    words = iter(shlex.split(entry["command"]))
    result = ["clang++", "-fsyntax-only", "-Werror"]
    started = False
    for word in words:
        if not started:  # launcher and compiler
            started = word.startswith("-")
            if not started:
                continue
        if word in ("-o", "-MF", "-MT", "-MQ"):
            next(words)
        elif word == "-include":
            header = next(words)
            if "cmake_pch" not in header:
                result += [word, header]
        elif word not in LEFT_OUT and not word.startswith("-M"):
            result.append(word)
    return result


def read(entry):
    done = subprocess.run(command(entry), cwd=entry["directory"], capture_output=True, text=True)
    return entry["file"], done.returncode, done.stderr


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if not shutil.which("clang++"):
        sys.exit("clang++ is missing. Install clang, or leave this check out.")
    entries = [e for e in json.loads((pathlib.Path(sys.argv[1]) / "compile_commands.json").read_text())
               if e["file"].endswith(".cpp") and "/third_party/" not in e["file"]]
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for done in concurrent.futures.as_completed([pool.submit(read, entry) for entry in entries]):
            file, status, text = done.result()
            if status:
                failed += 1
                print(f"{file}:\n{text}", flush=True)
    print(f"clang reads {len(entries)} files; {failed} with warnings or errors.")
    sys.exit(failed > 0)


main()
