#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Kills loopmark at random moments, runs the same command again until it ends, and compares every file with those of
runs that nobody killed.

usage: kills.py [--kills N] [--seed S] [--commands map,merge,...]

Exit code 1 when a file differs, a command does not go on, or something ends otherwise than by its kill.
"""

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import common

SIGNALS = [signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP]


class Command:
    """A command, and what to run when it was killed."""

    def __init__(self, name, start, again, result, prepare=None):
        self.name, self.start, self.again, self.result = name, start, again, result
        self.prepare = prepare or (lambda work: None)


def commands(base):
    a, b = base / "a", base / "b"
    algorithms = ["--algorithms", "engine"]

    def resume_map(out):
        partial = Path(f"{out}.partial")
        return ["map", "--resume", out, "-q"] if partial.exists() else ["map", a, "-o", out, "-q"]

    def same(words):
        return lambda out: [out if word == "OUT" else word for word in words]

    merge = same(["merge", base / "run_a", base / "run_b", "-o", "OUT", "-q"])
    extend = same(["extend", base / "run_a", b, "-o", "OUT", "-q"])
    relocalize = same(["relocalize", base / "run_a", b, "-o", "OUT", "-q", "--every", "4"])
    balance = same(["balance", base / "town", "-o", "OUT", "-q"])
    evaluate = same(["evaluate", base / "pairs/pairs.txt", "--data", base / "pairs", "-o", "OUT", "-q", *algorithms])
    drill = same(["drill", base / "run_town", "-o", "OUT", "-q", "--events", "2"])
    return {
        "map": Command("map", lambda out: ["map", a, "-o", out, "-q"], resume_map, lambda out: out),
        "merge": Command("merge", merge, merge, lambda out: out),
        "extend": Command("extend", extend, extend, lambda out: out),
        "relocalize": Command("relocalize", relocalize, relocalize, lambda out: out),
        "balance": Command("balance", balance, balance, lambda out: out),
        "evaluate": Command("evaluate", evaluate, evaluate, lambda out: out),
        "drill": Command("drill", drill, drill, lambda out: out),
    }


def start(arguments):
    return subprocess.Popen([common.program(), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            start_new_session=True)


def killed_once(arguments, after_s, how):
    """Starts a command and kills it; (whether the kill came in time, exit code, output)."""
    process = start(arguments)
    try:
        output, _ = process.communicate(timeout=after_s)
        return False, process.returncode, output.decode(errors="replace")
    except subprocess.TimeoutExpired:
        process.send_signal(how)
    try:
        output, _ = process.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
        return True, "does not end on " + how.name, output.decode(errors="replace")
    return True, process.returncode, output.decode(errors="replace")


def clean_run(command, work):
    """The sums of a run that nobody kills, and how long it takes."""
    out = work / (command.name + "_whole")
    begin = time.monotonic()
    common.must(command.start(out))
    return common.sums(command.result(out)), time.monotonic() - begin


def one_round(command, expected, seconds, work, rng, kills):
    """Kills up to `kills` times, then lets the command end; (kills, problem)."""
    out = work / (command.name + "_out")
    done = 0
    arguments = command.start(out)
    while done < kills:
        how = rng.choice(SIGNALS)
        in_time, code, output = killed_once(arguments, rng.random() * seconds, how)
        if in_time and code not in (-how, 130, 0):
            return done, f"{how.name}: ended with {code}\n{output}"
        if not in_time and code != 0:
            return done, f"ended with {code} by itself\n{output}"
        done += 1 if in_time else 0
        arguments = command.again(out)
        if code == 0:
            break
    else:
        code, output = common.run(arguments)
        if code != 0:
            return done, f"does not go on: exit {code}\n{output}"
    differing = common.difference(expected, common.sums(command.result(out)))
    return done, "other bytes: " + ", ".join(differing) if differing else ""


def prepare(base):
    common.small_logs(base)
    for name in ("a", "b"):
        common.must(["map", base / name, "-o", base / f"run_{name}", "-q"])
    common.must(["map", base / "town", "-o", base / "run_town", "-q"])
    common.must(["simulate", "--pairs", 8, "--negatives", 2, "--sensor", "vlp16", "-o", base / "pairs", "-q"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--commands", default="map,merge,extend,relocalize,evaluate,balance,drill")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    total, rounds, bad = 0, 0, 0
    with tempfile.TemporaryDirectory(prefix="loopmark_kills_") as folder:
        base = Path(folder)
        prepare(base)
        known = {}
        for name in options.commands.split(","):
            command = commands(base)[name]
            known[name] = (command, *clean_run(command, base))
        counts = dict.fromkeys(known, 0)
        while total < options.kills:
            command, expected, seconds = known[rng.choice(sorted(known))]
            work = Path(tempfile.mkdtemp(dir=base))
            kills, problem = one_round(command, expected, seconds, work, rng, 1 + rng.randrange(3))
            total, rounds = total + kills, rounds + 1
            counts[command.name] += kills
            if problem:
                bad += 1
                print(f"{command.name}, round {rounds}: {problem}", flush=True)
            shutil.rmtree(work)
    print(f"{total} kills in {rounds} runs ({', '.join(f'{n} {c}' for n, c in counts.items())}): {bad} problems")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
