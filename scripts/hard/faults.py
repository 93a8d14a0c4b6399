#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Lets every system call of a kind fail once in turn, and looks at what loopmark makes of it.

usage: faults.py [--every N] [--calls write,fsync,...] [--commands map,...]

Needs strace. A fault must end in exit code 0 (it did not matter) or 2, never in a signal or 70; what carries a whole
name must have the bytes of a run without faults, and the same command must go on afterwards.
"""

import argparse
import re
import shutil
import sys
import tempfile
from pathlib import Path

import common

# Calls and the error they return. Reads and opens before main() are the loader's, not ours.
FAULTS = {
    "write": ("write,pwrite64,writev", "ENOSPC"),
    "read": ("read,pread64,readv", "EIO"),
    "open": ("openat", "EMFILE"),
    "rename": ("rename,renameat,renameat2", "EIO"),
    "fsync": ("fsync,fdatasync,syncfs", "EIO"),
    "mkdir": ("mkdir,mkdirat", "EACCES"),
    "memory": ("mmap,brk,mremap", "ENOMEM"),
}


def count_calls(arguments, calls, log):
    """How many calls of these a run makes, and those before the program opens its first own file."""
    common.run(arguments, prefix=["strace", "-f", "-qq", "-o", str(log), "-e", f"trace={calls}"])
    lines = log.read_text(errors="replace").splitlines()
    return len([line for line in lines if re.match(r"\d+ +\w+\(", line)])


def loader_calls(calls, log):
    return count_calls(["--version"], calls, log)


def fails_well(command, calls, error, number, work, expected):
    out = work / "out"
    code, output = common.run(command(out), prefix=[
        "strace", "-f", "-qq", "-o", "/dev/null", "-e", f"trace={calls}", "-e", f"inject={calls}:error={error}:when={number}"])
    problems = []
    if code not in (0, 2):
        problems.append(f"exit {code}: {output.strip()[-200:]}")
    if out.exists() and code != 0:
        problems.append("failed, but left a folder of the whole name")
    if code == 0 and out.exists():
        differing = common.difference(expected, common.sums(out))
        if differing:
            problems.append("other bytes: " + ", ".join(differing))
    partial = Path(str(out) + ".partial")
    if not problems and code == 2:
        again = ["map", "--resume", out, "-q"] if command.__name__ == "map_log" and partial.exists() else command(out)
        code, output = common.run(again)
        if code != 0:
            problems.append(f"does not go on afterwards: exit {code}: {output.strip()[-200:]}")
        elif common.difference(expected, common.sums(out)):
            problems.append("other bytes after going on")
    for path in (out, partial):
        shutil.rmtree(path, ignore_errors=True)
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--every", type=int, default=1, help="only every n-th call")
    parser.add_argument("--calls", default=",".join(FAULTS))
    parser.add_argument("--commands", default="map,merge")
    options = parser.parse_args()
    if not shutil.which("strace"):
        print("faults: strace is not installed: skipped")
        return 77
    with tempfile.TemporaryDirectory(prefix="loopmark_faults_") as folder:
        work = Path(folder)
        a, b = common.small_logs(work)
        for name, log in (("run_a", a), ("run_b", b)):
            common.must(["map", log, "-o", work / name, "-q"])

        def map_log(out):
            return ["map", a, "-o", out, "-q", "--threads", 1]

        def merge_runs(out):
            return ["merge", work / "run_a", work / "run_b", "-o", out, "-q", "--threads", 1]

        bad, tried = 0, 0
        for command in [c for c in (map_log, merge_runs) if c.__name__.split("_")[0] in options.commands.split(",")]:
            common.must(command(work / "whole"))
            expected = common.sums(work / "whole")
            shutil.rmtree(work / "whole")
            for kind in options.calls.split(","):
                calls, error = FAULTS[kind]
                first = loader_calls(calls, work / "log")
                last = count_calls(command(work / "counted"), calls, work / "log")
                shutil.rmtree(work / "counted", ignore_errors=True)
                for number in range(first + 1, last + 1, options.every):
                    tried += 1
                    for problem in fails_well(command, calls, error, number, work, expected):
                        bad += 1
                        print(f"{command.__name__}, {kind} {number} of {last} ({error}): {problem}", flush=True)
        print(f"{tried} faults: {bad} problems")
        return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
