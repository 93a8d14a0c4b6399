#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Relocalization measured: each scan on its own against a map it is no part of.

usage: relocalization.py real LOGS WORK [--build FOLDER]         balm_loop and kitti_raw_city below LOGS
       relocalization.py simulated WORK [--build FOLDER] [--length 1000] [--town 22] [--scans 60] [--elsewhere 23]
       relocalization.py table NAME=ANSWERS.txt ... [--metres 0.6]

real: the last 20 scans of balm_loop against a map of the first 80 (right within 0.5 m), odd scans of kitti_raw_city against
a map of the even ones, its last third against a map of the first two thirds (0.6 m); judged by the logs' poses.txt.
simulated: day 1 (HDL-64E) is mapped; queries of day 2 (other parked cars) driven in the left lane, the other way, with an
HDL-32E, with an OS1-64 the other way, and of another town. What is in WORK already is taken as it is.
Whether a pose was given is what the relocalizer decides (docs/relocalization.md); right within 5 deg. table tells what
answers that are there come to.
"""
import argparse
import json
import math
import os
import subprocess
import sys
from pathlib import Path

RIGHT_DEG, MAPPED_M, MIN_OVERLAP = 5.0, 10.0, 0.3


def wilson(part, whole, z=1.959963984540054):
    if whole == 0:
        return 0.0, 1.0
    p, n = part / whole, whole
    middle, half = p + z * z / (2 * n), z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return (middle - half) / (1 + z * z / n), (middle + half) / (1 + z * z / n)


def share(part, whole):
    if whole == 0:
        return "-"
    low, high = wilson(part, whole)
    return f"{part}/{whole} = {100 * part / whole:.1f} % ({100 * low:.1f} - {100 * high:.1f})"


def read_answers(file):
    """Answers by scan, the most probable first: dicts of keyframe_m, overlap, error_m, error_deg, p, log_odds, given."""
    scans = {}
    for line in open(file):
        scan, *rest = line.split()
        keys = ("keyframe_m", "overlap", "error_m", "error_deg", "p", "log_odds", "given")
        scans.setdefault(int(scan), []).append(dict(zip(keys, map(float, rest[:7]))))
    for answers in scans.values():
        answers.sort(key=lambda a: -a["p"])
    return scans


def row(name, file, metres):
    scans = read_answers(file)
    right = lambda a: a["error_m"] < metres and a["error_deg"] < RIGHT_DEG
    mapped = [a for a in scans.values() if a[0]["keyframe_m"] < MAPPED_M or a[0]["overlap"] >= MIN_OVERLAP]
    found = sum(any(right(a) for a in answers) for answers in mapped)
    good = sum(a[0]["given"] > 0 and right(a[0]) for a in mapped)
    wrong = sum(a[0]["given"] > 0 and not right(a[0]) for a in scans.values())
    return (f"{name:24} recall {share(good, len(mapped)):40} wrong {share(wrong, len(scans)):36} "
            f"among the answers {share(found, len(mapped))}")


def run(command, log):
    print("+", " ".join(map(str, command)), file=sys.stderr)
    with open(log, "w") as out:
        subprocess.run([str(word) for word in command], check=True, stdout=out, stderr=subprocess.STDOUT)


class Tools:
    def __init__(self, build):
        self.loopmark = build / "apps/loopmark/loopmark"
        self.place_answers = build / "benchmarks/place_answers"

    def map(self, log, folder):
        if not folder.exists():
            run([self.loopmark, "map", "-q", log, "-o", folder], f"{folder}.log")

    def answers(self, folder, map_truth, log, truth, out, every=1, first=0):
        if not out.exists():
            part = out.with_suffix(".part")
            run([self.place_answers, folder, map_truth, log, truth, part, every, first], f"{out}.log")
            part.rename(out)


def part_of(log, folder, numbers):
    """A log of some scans of another, by links."""
    if folder.exists():
        return folder
    (folder / "velodyne").mkdir(parents=True)
    scans = sorted((log / "velodyne").iterdir())
    for place, number in enumerate(numbers):
        (folder / "velodyne" / f"{place:06d}{scans[number].suffix}").symlink_to(scans[number].resolve())
    for name in ("times.txt", "poses.txt"):
        lines = (log / name).read_text().splitlines()
        (folder / name).write_text("".join(lines[number] + "\n" for number in numbers))
    for name in ("sweep.txt",):
        if (log / name).exists():
            (folder / name).write_text((log / name).read_text())
    return folder


def split(tools, log, work, name, mapped, asked, metres):
    day = part_of(log, work / f"{name}-mapped", mapped)
    query = part_of(log, work / f"{name}-asked", asked)
    tools.map(day, work / f"{name}-run")
    out = work / f"{name}.answers.txt"
    tools.answers(work / f"{name}-run", day / "poses.txt", query, query / "poses.txt", out)
    return row(name, out, metres)


def real(tools, logs, work):
    balm, kitti = logs / "balm_loop", logs / "kitti_raw_city"
    n = len(list((balm / "velodyne").iterdir()))
    m = len(list((kitti / "velodyne").iterdir()))
    print(split(tools, balm, work, "balm-last-20", range(80), range(n - 20, n), 0.5))
    print(split(tools, kitti, work, "kitti-odd", range(0, m, 2), range(1, m, 2), 0.6))
    print(split(tools, kitti, work, "kitti-last-third", range(2 * m // 3), range(2 * m // 3, m), 0.6))


def town_poses(log):
    """The true poses of a simulated log in the frame of its town, as a file."""
    out = log / "town_poses.txt"
    first = json.loads((log / "town.json").read_text())["T_town_first"]
    lines = []
    for line in (log / "poses.txt").read_text().splitlines():
        v = list(map(float, line.split())) + [0.0, 0.0, 0.0, 1.0]
        T = [sum(first[4 * r + k] * v[4 * k + c] for k in range(4)) for r in range(3) for c in range(4)]
        lines.append(" ".join(f"{x:.9f}" for x in T))
    out.write_text("\n".join(lines) + "\n")
    return out


QUERIES = {"left": ["--lane", "left", "--seed", 6], "rev": ["--direction", "reverse", "--seed", 5],
           "h32": ["--sensor", "hdl32e", "--seed", 7],
           "os1": ["--sensor", "os1-64", "--seed", 8, "--direction", "reverse"]}


def simulated(tools, work, length, town, scans, elsewhere):
    def drive(name, *more):
        log = work / name
        if not log.exists():
            run([tools.loopmark, "simulate", "-q", "-o", log, "--length", length, *more], work / f"{name}.log")
        return log

    day1 = drive(f"t{town}-day1", "--town", town)
    tools.map(day1, work / f"t{town}-run")
    others = {name: drive(f"t{town}-{name}", "--town", town, "--day", 2, "--rate", 5, *more)
              for name, more in QUERIES.items()}
    others["elsewhere"] = drive(f"t{elsewhere}-day1", "--town", elsewhere, "--rate", 5)
    for name, log in others.items():
        count = len((log / "poses.txt").read_text().splitlines())
        out = work / f"t{town}-{name}.answers.txt"
        truth = "-" if name == "elsewhere" else town_poses(log)
        tools.answers(work / f"t{town}-run", town_poses(day1), log, truth, out, max(1, count // scans))
        print(row(f"town {town} {name}", out, 0.6), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["real", "simulated", "table"])
    parser.add_argument("paths", nargs="+")
    here = Path(__file__).resolve().parent.parent
    parser.add_argument("--build", type=Path, default=here / "build/release")
    parser.add_argument("--length", type=float, default=1000)
    parser.add_argument("--town", type=int, default=22)
    parser.add_argument("--elsewhere", type=int, default=23)
    parser.add_argument("--scans", type=int, default=60)
    parser.add_argument("--metres", type=float, default=0.6)
    a = parser.parse_args()
    if a.what == "table":
        for item in a.paths:
            name, _, file = item.partition("=")
            print(row(name, file, a.metres))
        return
    work = Path(a.paths[-1]).resolve()
    os.makedirs(work, exist_ok=True)
    if a.what == "real":
        real(Tools(a.build), Path(a.paths[0]).resolve(), work)
    else:
        simulated(Tools(a.build), work, a.length, a.town, a.scans, a.elsewhere)


if __name__ == "__main__":
    main()
