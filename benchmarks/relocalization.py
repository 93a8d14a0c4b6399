#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Relocalization measured, with no pose handed over.

usage: relocalization.py real LOGS WORK                  balm_loop and kitti_raw_city below LOGS
       relocalization.py simulated WORK [--length 1000] [--asked 1000] [--town 22] [--elsewhere 23] [--scans 60]
                                   [--starts 60] [--events 0]
       relocalization.py fitting WORK [--length 500] [--towns 411:tour,412:twins,413:explore] [--scans 30]
       relocalization.py table NAME=ANSWERS.txt ... [--metres 0.6]

real: the last 20 scans of balm_loop against a map of the first 80 (right within 0.5 m), odd scans of kitti_raw_city against
a map of the even ones, its last third against a map of the first two thirds (0.6 m); judged by the logs' poses.txt.
simulated: day 1 (HDL-64E) is mapped; queries of day 2 (other parked cars) driven in the left lane, the other way, with an
HDL-32E, with an OS1-64 the other way, and of another town: single scans, each on its own and without its motion during
the sweep (place_answers), and relocalizers started at places all over the logs, which take scans as they are
(place_starts: what the first scan gives, and the first 2 s of driving, in which the sensor moves);
then a drill of --events, the drive of the other direction taking part. --asked: metres of each drive of day 2; scans
farther than 10 m from the map do not count.
fitting: the same logs of small towns, single scans only, for scripts/fit_places.py; one file of answers a town.
What is in WORK already is taken as it is; --again asks the maps anew. Whether a pose was given is what the relocalizer
decides (docs/results/relocalization.md); right within 5 deg. table tells what answers that are there come to.
"""
import argparse
import json
import math
import os
import shutil
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
        scans.setdefault(scan, []).append(dict(zip(keys, map(float, rest[:7]))))
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


def row_of_starts(name, file, elsewhere):
    """First scans and the first seconds of driving; a start is wrong when any pose given in them is."""
    starts = [line.split() for line in open(file)]
    mapped = [s for s in starts if elsewhere or float(s[1]) < MAPPED_M]
    first = sum(s[2] == "1" for s in mapped)
    found = sum(float(s[3]) >= 0.0 and s[6] == "0" for s in mapped)
    wrong_first, wrong = (sum(s[2] == "-1" for s in mapped), sum(s[6] != "0" for s in mapped))
    times = sorted(float(s[3]) for s in mapped if float(s[3]) >= 0.0)
    median = f", median {times[len(times) // 2]:.1f} s, last {times[-1]:.1f} s" if times else ""
    return (f"{name:24} first scan {share(first, len(mapped)):36} wrong {wrong_first:2}   "
            f"driving {share(found, len(mapped)):36} wrong {share(wrong, len(mapped))}{median}")


def run(command, log):
    """Runs a program; returns its processor seconds and its peak of memory in MB."""
    print("+", " ".join(map(str, command)), file=sys.stderr, flush=True)
    with open(log, "w") as out:
        process = subprocess.Popen([str(word) for word in command], stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        raise SystemExit(f"it failed; what it said is in {log}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


class Tools:
    def __init__(self, build, again):
        self.loopmark = build / "apps/loopmark/loopmark"
        self.place_answers = build / "benchmarks/place_answers"
        self.place_starts = build / "benchmarks/place_starts"
        self.again = again

    def map(self, log, folder):
        if not folder.exists():
            cpu_s, peak_mb = run([self.loopmark, "map", "-q", log, "-o", folder], f"{folder}.log")
            print(f"{folder.name}: mapped in {cpu_s:.0f} s of processor time, {peak_mb:.0f} MB", flush=True)

    def ask(self, words, out, more):
        """Writes `out` if it is not there; .cost beside it tells processor seconds and the peak of memory."""
        if self.again or not out.exists():
            part = out.with_suffix(".part")
            cpu_s, peak_mb = run([*words, part, *more], f"{out}.log")
            part.rename(out)
            Path(f"{out}.cost").write_text(f"{cpu_s:.1f} s of processor time, peak {peak_mb:.0f} MB\n")

    def answers(self, folder, map_truth, log, truth, out, every=1, first=0):
        self.ask([self.place_answers, folder, map_truth, log, truth], out, [every, first])

    def starts(self, folder, map_truth, log, truth, out, count, seconds):
        self.ask([self.place_starts, folder, map_truth, log, truth], out, [count, seconds])


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
FITTED, FOREIGN = ("rev", "h32", "os1"), ("h32", "os1")


def drive(tools, work, name, length, *more):
    log = work / name
    if not log.exists():
        run([tools.loopmark, "simulate", "-q", "-o", log, "--length", length, *more], work / f"{name}.log")
    return log


def queries(tools, work, names, length, town, *more):
    return {name: drive(tools, work, f"t{town}-{name}", length, "--town", town, "--day", 2, "--rate", 5,
                        *QUERIES[name], *more) for name in names}


def every_nth(log, scans):
    return max(1, len((log / "poses.txt").read_text().splitlines()) // scans)


def simulated(tools, work, a):
    town = a.town
    day1 = drive(tools, work, f"t{town}-day1", a.length, "--town", town)
    tools.map(day1, work / f"t{town}-run")
    others = queries(tools, work, QUERIES, a.asked, town)
    others["elsewhere"] = drive(tools, work, f"t{a.elsewhere}-day1", a.asked, "--town", a.elsewhere, "--rate", 5)
    for name, log in others.items():
        elsewhere = name == "elsewhere"
        asked = (work / f"t{town}-run", town_poses(day1), log, "-" if elsewhere else town_poses(log))
        if a.scans > 0:
            out = work / f"t{town}-{name}.answers.txt"
            tools.answers(*asked, out, every_nth(log, a.scans))
            print(row(f"town {town} {name}", out, 0.6), Path(f"{out}.cost").read_text().strip(), flush=True)
        if a.starts > 0:
            out = work / f"t{town}-{name}.starts.txt"
            tools.starts(*asked, out, a.starts, a.seconds if not elsewhere else 0.5)
            print(row_of_starts(f"town {town} {name}", out, elsewhere), Path(f"{out}.cost").read_text().strip(),
                  flush=True)
    if a.events > 0:
        drill(tools, work, a)


def drill(tools, work, a):
    """Cuts in day 1, and in the drive of day 2 that goes the other way."""
    town, out = a.town, work / f"t{a.town}-drill"
    if a.again and out.exists():
        shutil.rmtree(out)
    if not out.exists():
        run([tools.loopmark, "drill", "-q", work / f"t{town}-run", "-o", out, "--events", a.events, "--drive",
             work / f"t{town}-rev", "--truth", work / f"t{town}-rev/town_poses.txt", "--map-truth",
             work / f"t{town}-day1/town_poses.txt"], f"{out}.log")
    for name, counts in json.loads((out / "summary.json").read_text())["by"].items():
        events = counts["events"]
        print(f"drill {name:20} in time {share(counts['in_time'], events):36} wrong {share(counts['wrong'], events)}")


def fitting(tools, work, a):
    towns = [item.split(":") for item in a.towns.split(",")]
    logs = {}
    for town, route in towns:
        day1 = drive(tools, work, f"t{town}-day1", a.length, "--town", town, "--route", route)
        tools.map(day1, work / f"t{town}-run")
        logs[town] = queries(tools, work, FITTED, a.length, town, "--route", route)
    for place, (town, _) in enumerate(towns):
        elsewhere = towns[(place + 1) % len(towns)][0]
        others = [(name, log, town_poses(log)) for name, log in logs[town].items()]
        others += [("elsewhere-" + name, logs[elsewhere][name], "-") for name in FOREIGN]
        whole = work / f"t{town}.answers.txt"
        with open(whole, "w") as all_answers:
            for name, log, truth in others:
                out = work / f"t{town}-{name}.answers.txt"
                tools.answers(work / f"t{town}-run", town_poses(work / f"t{town}-day1"), log, truth, out,
                              every_nth(log, a.scans))
                all_answers.writelines(f"{name}-{line}" for line in open(out))
                print(row(f"town {town} {name}", out, 0.6), flush=True)
        print(row(f"town {town}", whole, 0.6), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["real", "simulated", "fitting", "table"])
    parser.add_argument("paths", nargs="+")
    here = Path(__file__).resolve().parent.parent
    parser.add_argument("--build", type=Path, default=here / "build/release")
    parser.add_argument("--length", type=float)
    parser.add_argument("--asked", type=float, default=1000)
    parser.add_argument("--town", type=int, default=22)
    parser.add_argument("--towns", default="411:tour,412:twins,413:explore")
    parser.add_argument("--elsewhere", type=int, default=23)
    parser.add_argument("--scans", type=int)
    parser.add_argument("--starts", type=int, default=60)
    parser.add_argument("--events", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--metres", type=float, default=0.6)
    parser.add_argument("--again", action="store_true")
    a = parser.parse_args()
    if a.what == "table":
        for item in a.paths:
            name, _, file = item.partition("=")
            print(row(name, file, a.metres))
        return
    a.length = a.length or (500 if a.what == "fitting" else 1000)
    a.scans = a.scans if a.scans is not None else (30 if a.what == "fitting" else 60)
    tools = Tools(a.build, a.again)
    work = Path(a.paths[-1]).resolve()
    os.makedirs(work, exist_ok=True)
    if a.what == "real":
        real(tools, Path(a.paths[0]).resolve(), work)
    else:
        (simulated if a.what == "simulated" else fitting)(tools, work, a)


if __name__ == "__main__":
    main()
