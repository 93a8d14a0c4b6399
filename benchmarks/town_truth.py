#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The true poses of a simulated drive in its town's frame (KITTI format), which all drives of the town share.

  town_truth.py LOG > truth.txt
"""
import json
import pathlib
import sys


def matrix(values):
    return [list(values[4 * row:4 * row + 4]) for row in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def main():
    log = pathlib.Path(sys.argv[1])
    first = matrix(json.loads((log / "town.json").read_text())["T_town_first"])
    for line in (log / "poses.txt").read_text().splitlines():
        pose = product(first, matrix([float(word) for word in line.split()]))
        print(" ".join(f"{pose[i][j]:.9e}" for i in range(3) for j in range(4)))


if __name__ == "__main__":
    main()
