#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Damages files of logs, runs, results and configurations, and looks at what whole commands make of them.

usage: mutations.py [--runs N] [--seed S] [--jobs N] [--keep FOLDER]

Each must end with exit code 0, 2 or 130, in time, within 4 GB, and leave no temporary file and, unless it ended well, no
folder of the whole name. What breaks that is kept in FOLDER.
"""

import argparse
import concurrent.futures
import os
import random
import re
import shutil
import struct
import sys
import tempfile
import zlib
from pathlib import Path

import common

MEMORY = 4 << 30
NUMBERS = [b"0", b"-1", b"1", b"4294967295", b"4294967296", b"18446744073709551615", b"1e308", b"1e999", b"nan", b"inf",
           b"100000000", b"0x1p+900", b"", b",", b"-0"]


def flipped(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 4, 64])):
        if data:
            data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def cut(data, rng):
    return data[:rng.randrange(len(data) + 1)]


def inflated(data, rng):
    at = rng.randrange(len(data) + 1)
    filling = rng.choice([b"\0", b"\xff", b"[", b" ", b"\n", b"9", data[at:at + 64] or b"a"])
    return data[:at] + filling * rng.choice([1, 100, 100_000]) + data[at:]


def renumbered(data, rng):
    """Another number in place of one, as text or in binary."""
    found = [match for match in re.finditer(rb"[-+0-9.a-fxp]*[0-9][-+0-9.a-fxp]*", data[:200_000])]
    if found and rng.random() < 0.7:
        match = rng.choice(found)
        return data[:match.start()] + rng.choice(NUMBERS) + data[match.end():]
    if len(data) < 8:
        return data
    at = rng.randrange(len(data) - 7)
    number = rng.choice([0, 1, 0x7fffffff, 0xffffffff, 1 << 31, 1 << 40, (1 << 64) - 1])
    packed = struct.pack("<Q", number)[:rng.choice([4, 8])]
    return data[:at] + packed + data[at + len(packed):]


def shuffled(data, rng):
    lines = data.split(b"\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    if rng.random() < 0.5:
        lines[i], lines[j] = lines[j], lines[i]
    else:
        lines.insert(i, lines[j])
    return b"\n".join(lines)


MUTATIONS = [flipped, cut, inflated, renumbered, renumbered, shuffled]


def with_right_checksums(data):
    lines = [line[9:] for line in data.split(b"\n") if len(line) > 9]
    return b"".join(b"%08x %s\n" % (zlib.crc32(line), line) for line in lines)


def damage(folder, rng):
    """Damages one to three files below a folder; what was done."""
    told = []
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    for _ in range(rng.choice([1, 1, 2, 3])):
        path = rng.choice(files)
        mutation = rng.choice(MUTATIONS)
        data = mutation(path.read_bytes(), rng)
        if path.suffix in (".rec", ".records", ".times") and rng.random() < 0.8:
            data = with_right_checksums(data)
        path.unlink()  # a hard link to the sound one
        path.write_bytes(data)
        told.append(f"{path.relative_to(folder)} {mutation.__name__}")
    return told


def linked(source, target):
    shutil.copytree(source, target, copy_function=os.link)


def subjects(base):
    """(what is damaged, the commands that read it)"""
    victim, out = "VICTIM", "OUT"
    log = [["doctor", victim], ["doctor", victim], ["map", victim, "-o", out, "-q"]]
    scans = [["register", victim + "/0.pcd", victim + "/1.pcd"], ["register", victim + "/0.ply", victim + "/1.ply"]]
    run = [["loops", victim], ["loops", victim, "--veto", "k1-k0", "-o", out], ["check", victim],
           ["merge", victim, base / "run_b", "-o", out, "-q"], ["why", victim, "8-0"],
           ["relocalize", victim, base / "b", "-o", out, "-q", "--every", "6"]]
    result = [["evaluate", "merge", victim, "-o", out]]
    config = [["config", "check", victim + "/config.yaml"], ["doctor", base / "a", "--config", victim + "/config.yaml"]]
    return [("a", log), ("pcd_log", log), ("rawlog_log", log), ("scans", scans), ("run_a", run), ("run_a", run),
            ("result", result), ("config", config)]


def prepare(base):
    a, _ = common.small_logs(base)
    for name in ("a", "b"):
        common.must(["map", base / name, "-o", base / f"run_{name}", "-q"])
    common.must(["simulate", "--length", 8, "--sensor", "vlp16", "--format", "pcd", "-o", base / "pcd_log", "-q"])
    common.must(["simulate", "--length", 8, "--sensor", "vlp16", "--format", "rawlog", "-o", base / "rawlog_log", "-q"])
    common.must(["simulate", "--pairs", 3, "--negatives", 1, "--sensor", "vlp16", "-o", base / "pairs", "-q"])
    common.must(["evaluate", base / "pairs/pairs.txt", "--data", base / "pairs", "-o", base / "result", "-q"])
    (base / "scans").mkdir()
    for i, scan in enumerate(sorted((base / "pcd_log").rglob("*.pcd"))[:2]):
        shutil.copy(scan, base / "scans" / f"{i}.pcd")
    (base / "config").mkdir()
    common.must(["config", "dump", "-o", base / "config/config.yaml"])


def one(base, seed, keep):
    rng = random.Random(seed)
    name, commands = rng.choice(subjects(base))
    work = Path(tempfile.mkdtemp(dir=base / "work"))
    victim, out = work / "victim", work / "out"
    linked(base / name, victim)
    told = damage(victim, rng)
    words = [str(word).replace("VICTIM", str(victim)).replace("OUT", str(out)) for word in rng.choice(commands)]
    code, output = common.run(words, timeout=120, memory_bytes=MEMORY)
    problem = ""
    if code not in (0, 2, 130):
        problem = "does not end" if code is None else f"exit {code}"
    elif code != 0 and out.exists() and words[0] != "evaluate":
        problem = f"exit {code}, but a folder of the whole name"
    elif any(path.name.endswith(".tmp") for path in work.rglob("*")):
        problem = "a temporary file is left"
    if problem and keep:
        shutil.copytree(victim, Path(keep) / f"{seed}", dirs_exist_ok=True)
    shutil.rmtree(work, ignore_errors=True)
    return code, f"seed {seed}: {' '.join(words)}: {problem} ({'; '.join(told)})\n{output[-300:]}" if problem else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", help="folder for what broke something")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="loopmark_mutations_") as folder:
        base = Path(folder)
        prepare(base)
        (base / "work").mkdir()
        codes, bad = {}, 0
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for code, problem in pool.map(lambda i: one(base, options.seed * 1_000_000 + i, options.keep),
                                          range(options.runs)):
                codes[code] = codes.get(code, 0) + 1
                if problem:
                    bad += 1
                    print(problem, flush=True)
    print(f"{options.runs} runs, exit codes {dict(sorted(codes.items(), key=str))}: {bad} problems")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
