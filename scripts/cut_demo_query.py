#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""cut_demo_query.py LOG MAPPED QUERY: a few scans of the simulated drive LOG, from half of its way on, as a log of their
own. Their true poses are given in the frame of the simulated drive MAPPED, so that answers can be judged in its map."""
import json
import shutil
import sys
from pathlib import Path

SCANS = 4


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse(pose):
    turned = [[pose[j][i] for j in range(3)] for i in range(3)]
    back = [-sum(turned[i][k] * pose[k][3] for k in range(3)) for i in range(3)]
    return [turned[i] + [back[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def first_pose(log):
    """T_town_first of a simulated drive."""
    numbers = json.loads((log / "town.json").read_text())["T_town_first"]
    return [numbers[4 * i:4 * i + 4] for i in range(4)]


def read_poses(log):
    rows = [[float(word) for word in line.split()] for line in (log / "poses.txt").read_text().splitlines()]
    return [[row[4 * i:4 * i + 4] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]] for row in rows]


def half_way(poses):
    steps = [sum((b[i][3] - a[i][3]) ** 2 for i in range(3)) ** 0.5 for a, b in zip(poses, poses[1:])]
    driven = 0.0
    for i, step in enumerate(steps):
        driven += step
        if driven >= 0.5 * sum(steps):
            return i
    return 0


def main():
    log, mapped, query = (Path(argument) for argument in sys.argv[1:])
    poses = read_poses(log)
    times = (log / "times.txt").read_text().splitlines()
    T_mapped_log = product(inverse(first_pose(mapped)), first_pose(log))
    begin = half_way(poses)
    (query / "velodyne").mkdir(parents=True)
    with (query / "poses.txt").open("w") as pose_file, (query / "times.txt").open("w") as time_file:
        for k in range(SCANS):
            shutil.copy(log / "velodyne" / f"{begin + k:06d}.bin", query / "velodyne" / f"{k:06d}.bin")
            pose = product(T_mapped_log, poses[begin + k])
            pose_file.write(" ".join(f"{pose[i][j]:.9e}" for i in range(3) for j in range(4)) + "\n")
            time_file.write(times[begin + k] + "\n")
    for name in ("sweep.txt", "calib.txt"):
        shutil.copy(log / name, query / name)


if __name__ == "__main__":
    main()
