# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts that judge `loopmark map` share: running it, reading what it wrote, motions. Python 3, no packages."""
import argparse
import csv
import hashlib
import math
import os
import subprocess
import sys
import time
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
# Differ from run to run, as they tell times and arguments.
OWN_FILES = {"manifest.json", "timings.json", "report.html", "job.json"}  # times, and the folder of the run


def parser(description):
    """With what every script takes: the program, a place for what it writes, threads."""
    p = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--loopmark", default=SOURCE / "build/release/apps/loopmark/loopmark", type=Path)
    p.add_argument("--work", default=SOURCE / "build/benchmarks", type=Path, help="drives and runs are kept there")
    p.add_argument("--threads", default=2, type=int)
    return p


class Ran:
    """A finished program: what it took and what it said."""

    def __init__(self, words):
        started = time.monotonic()
        process = subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, text=True)
        self.output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        self.seconds = time.monotonic() - started
        self.cpu_s = usage.ru_utime + usage.ru_stime
        self.peak_mb = usage.ru_maxrss / 1024
        code = os.waitstatus_to_exitcode(status)
        if code != 0:
            sys.exit(f"error: exit code {code} of: {' '.join(str(word) for word in words)}")


def run_map(args, log, run, *more):
    """Maps `log` into a fresh folder `run`."""
    remove(run)
    run.parent.mkdir(parents=True, exist_ok=True)
    return Ran([args.loopmark, "map", log, "-o", run, "-q", "--threads", args.threads, *more])


def simulated(args, name, *more):
    """The drive `name` in the work folder, made unless it is there."""
    drive = args.work / name
    if not drive.exists():
        remove(drive)
        drive.parent.mkdir(parents=True, exist_ok=True)
        print(f"simulating {drive}", flush=True)
        Ran([args.loopmark, "simulate", "-o", drive, "-q", "--threads", args.threads, *more])
    return drive


def remove(folder):
    for name in (folder, Path(str(folder) + ".partial")):
        subprocess.run(["rm", "-rf", str(name)], check=True)


def read_kitti(path):
    """3 x 4 matrices, as lists of rows."""
    poses = []
    for line in path.read_text().splitlines():
        v = [float(word) for word in line.split()]
        poses.append([v[0:4], v[4:8], v[8:12]])
    return poses


def inverse(T):
    R = [[T[c][r] for c in range(3)] for r in range(3)]
    return [R[r] + [-sum(R[r][k] * T[k][3] for k in range(3))] for r in range(3)]


def product(A, B):
    return [[sum(A[r][k] * B[k][c] for k in range(3)) + (A[r][3] if c == 3 else 0.0) for c in range(4)]
            for r in range(3)]


def difference(A, B):
    """Translation error (metres) as the published sets define it, |t_A - t_B|, and the angle between the rotations."""
    metres = math.dist([A[r][3] for r in range(3)], [B[r][3] for r in range(3)])
    trace = sum(A[r][k] * B[r][k] for r in range(3) for k in range(3))
    return metres, math.degrees(math.acos(max(-1.0, min(1.0, (trace - 1.0) / 2.0))))


def motion(poses, source, target):
    """T_target_source: moves points of scan `source` into scan `target`."""
    return product(inverse(poses[target]), poses[source])


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def components(run):
    return len({row["component"] for row in table(run / "covariances.csv")})


def accepted_loops(run):
    """(source scan, target scan, T_target_source) of the loops that the map rests on."""
    loops = []
    for row in table(run / "loops.csv"):
        if row["accepted"] == "1":
            roll, pitch, yaw = (math.radians(float(row[name + "_deg"])) for name in ("roll", "pitch", "yaw"))
            cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
            cy, sy = math.cos(yaw), math.sin(yaw)
            T = [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, float(row["x"])],
                 [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, float(row["y"])],
                 [-sp, cp * sr, cp * cr, float(row["z"])]]
            loops.append((int(row["source_scan"]), int(row["target_scan"]), T))
    return loops


def hashes(run):
    """SHA-256 of every file of a run that must not differ from run to run."""
    result = {}
    for path in sorted(run.rglob("*")):
        if path.is_file() and path.name not in OWN_FILES:
            result[str(path.relative_to(run))] = hashlib.sha256(path.read_bytes()).hexdigest()
    return result


class Verdicts:
    """Says line by line what was asked for and what came out; ends the script with 1 where something failed."""

    def __init__(self):
        self.failed = 0

    def line(self, fine, text):
        self.failed += not fine
        print(f"  {'pass' if fine else 'FAIL'}  {text}", flush=True)

    def end(self):
        print("all as asked for" if self.failed == 0 else f"{self.failed} not as asked for")
        sys.exit(1 if self.failed else 0)
