#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks all sources with clang, warnings as errors; the tests build with g++.

    tools/check_clang.py BUILD                BUILD: a configured build folder, with its compile_commands.json
    tools/check_clang.py BUILD --library      only the library and the command line, as in CI
    tools/check_clang.py BUILD --since REF    only what differs from a commit, and what includes a header that does
    tools/check_clang.py BUILD FILE ...       only these sources

Sources are only parsed, but without the precompiled headers of g++, so all of them take long. With --since a changed
header is checked with one source that includes it, with --every in all of them.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

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
    return [*result, "-Wno-overlength-strings"]  # as in cmake/warnings.cmake


def read(entry):
    done = subprocess.run(command(entry), cwd=entry["directory"], capture_output=True, text=True)
    return entry["file"], done.returncode, done.stderr


def changed_since(root, ref):
    """Files that differ from a commit, including untracked ones."""
    names = []
    for words in (["diff", "--name-only", "--diff-filter=d", ref], ["ls-files", "--others", "--exclude-standard"]):
        done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"git cannot compare with '{ref}': {done.stderr.strip().splitlines()[0]}")
        names += done.stdout.split("\n")
    return {root / name for name in names if name.endswith((".cpp", ".hpp"))}


def one_by_one(units):
    """Sources of unity builds, one by one."""
    entries = {}
    for unit, entry in units.items():
        if "unity" not in unit.parts:
            entries[unit] = entry
            continue
        for name in INCLUDE.findall(unit.read_text()):
            source = next(folder / name for folder in Includes(ROOT).folders if (folder / name).is_file()).resolve()
            entries[source] = {**entry, "file": str(source), "command": entry["command"].replace(str(unit), str(source))}
    return entries


INCLUDE = re.compile(r'^\s*#include\s+["<]([^">]+)[">]', re.MULTILINE)


class Includes:
    """Files of the repository that a source includes, directly or indirectly."""

    def __init__(self, root):
        self.folders = [root / "src", root / "tests", root / "apps" / "polhode", root / "benchmarks"]
        self.direct, self.all = {}, {}

    def of(self, file):
        if file not in self.direct:
            found = set()
            text = file.read_text(errors="replace") if file.exists() else ""
            for name in INCLUDE.findall(text):
                for folder in [file.parent, *self.folders]:
                    if (folder / name).is_file():
                        found.add((folder / name).resolve())
                        break
            self.direct[file] = found
        return self.direct[file]

    def through(self, file):
        if file not in self.all:
            seen, ahead = set(), [file]
            while ahead:
                for next_file in self.of(ahead.pop()) - seen:
                    seen.add(next_file)
                    ahead.append(next_file)
            self.all[file] = seen
        return self.all[file]


def chosen(sources, changed, includes, every):
    """Changed sources, and for each changed header those that include it: all, or one."""
    picked = {source for source in sources if source in changed}
    for header in sorted(file for file in changed if file.suffix == ".hpp"):
        users = [source for source in sources if header in includes.through(source)]
        if every:
            picked.update(users)
        elif users and not picked.intersection(users):
            picked.add(min(users, key=lambda source: (len(includes.through(source)), source)))
    return picked


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path, metavar="BUILD")
    parser.add_argument("files", nargs="*", type=pathlib.Path, metavar="FILE")
    parser.add_argument("--library", action="store_true", help="without tests and benchmarks")
    parser.add_argument("--since", metavar="REF", help="only what differs from this commit")
    parser.add_argument("--every", action="store_true", help="with --since: all sources that include a changed header")
    parser.add_argument("-j", type=int, default=os.cpu_count(), metavar="N", help="number of parallel jobs")
    given = parser.parse_args()
    if not shutil.which("clang++"):
        sys.exit("clang++ is missing. Install clang, or skip this check.")
    commands = given.build / "compile_commands.json"
    if not commands.is_file():
        sys.exit(f"{commands} is missing. Configure the build first: cmake --preset release.")
    entries = {pathlib.Path(e["file"]).resolve(): e for e in json.loads(commands.read_text())
               if e["file"].endswith(".cpp") and "/third_party/" not in e["file"]}
    if given.files or given.since:
        entries = one_by_one(entries)
    sources = set(entries)
    if given.files:
        sources = {file.resolve() for file in given.files}
        if unknown := sources - set(entries):
            sys.exit(f"{sorted(unknown)[0]} is not compiled in {given.build}.")
    elif given.since:
        sources = chosen(sorted(entries), changed_since(ROOT, given.since), Includes(ROOT), given.every)
    if given.library:
        sources = {source for source in sources if not {"tests", "benchmarks"} & set(source.relative_to(ROOT).parts)}
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(given.j) as pool:
        for done in concurrent.futures.as_completed([pool.submit(read, entries[source]) for source in sorted(sources)]):
            file, status, text = done.result()
            if status:
                failed += 1
                print(f"{file}:\n{text}", flush=True)
    print(f"clang reads {len(sources)} of {len(entries)} files; {failed} with warnings or errors.")
    sys.exit(failed > 0)


main()
