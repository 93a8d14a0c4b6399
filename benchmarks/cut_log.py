#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A simulated log with scans taken out and one jump, as a new log of links to the same scans.

  cut_log.py LOG CUT --cuts 5,10,20,40,60 --jump 60

Cuts of so many seconds are spread evenly over the drive. The jump takes out so many seconds in the middle and closes up
the stamps, so that the sensor seems to be elsewhere from one scan to the next. The cuts come in the order in which, by
the true poses, the segments share most places: parts that share none cannot become one map. It says how many scans the
weakest tie between segments has (scans within 8 m of another segment). Needs nothing but Python.
"""
import argparse
import itertools
import math
import os
import pathlib
import shutil


def kept_scans(stamps, cuts, jump_s):
    """(scan, stamp) of what is left: cuts leave gaps in the stamps, the jump does not."""
    spans = list(cuts)
    spans.insert(len(cuts) // 2 + 1, jump_s)
    pause = (stamps[-1] - stamps[0] - sum(spans)) / (len(spans) + 1)
    if pause < 5.0:
        raise SystemExit("the drive is too short for these cuts")
    gaps, at = [], stamps[0]
    for span in spans:
        at += pause
        gaps.append((at, at + span))
        at += span
    jump_at = gaps.pop(len(cuts) // 2 + 1)[0]
    kept = []
    for scan, stamp in enumerate(stamps):
        if any(a <= stamp < b for a, b in gaps) or jump_at <= stamp < jump_at + jump_s:
            continue
        kept.append((scan, stamp if stamp < jump_at else stamp - jump_s))
    return kept


def near_scans(positions, every, near_m=8.0):
    """Pairs of every n-th scan that are near each other."""
    chosen = range(0, len(positions), every)
    return [(i, j) for i in chosen for j in chosen if j < i and math.dist(positions[i], positions[j]) < near_m]


def weakest_tie(kept, near, every):
    """Scans that hold the segments together where they hold together least: on the strongest ties that join all."""
    segment, segments = {kept[0]: 0}, 1
    for before, scan in zip(kept, kept[1:]):
        segments += scan != before + 1
        segment[scan] = segments - 1
    ties = {}
    for i, j in near:
        if i in segment and j in segment and segment[i] != segment[j]:
            ties.setdefault(tuple(sorted((segment[i], segment[j]))), set()).add(i)
    joined, weakest = {0}, len(kept)
    while len(joined) < segments:
        ways = [(len(scans), pair) for pair, scans in ties.items() if (pair[0] in joined) != (pair[1] in joined)]
        if not ways:
            return 0
        strength, pair = max(ways)
        joined.update(pair)
        weakest = min(weakest, strength * every)
    return weakest


def best_order(stamps, positions, cuts, jump_s, every=5):
    near = near_scans(positions, every)
    orders = sorted(set(itertools.permutations(cuts)))
    return max((weakest_tie([scan for scan, _ in kept_scans(stamps, order, jump_s)], near, every), order)
               for order in orders)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=pathlib.Path)
    parser.add_argument("cut", type=pathlib.Path)
    parser.add_argument("--cuts", default="5,10,20,40,60")
    parser.add_argument("--jump", type=float, default=60.0)
    a = parser.parse_args()
    stamps = [float(line) for line in (a.log / "times.txt").read_text().split()]
    poses = (a.log / "poses.txt").read_text().splitlines()
    positions = [[float(line.split()[k]) for k in (3, 7, 11)] for line in poses]
    tie, cuts = best_order(stamps, positions, [float(c) for c in a.cuts.split(",")], a.jump)
    kept = kept_scans(stamps, cuts, a.jump)
    (a.cut / "velodyne").mkdir(parents=True)
    for number, (scan, _) in enumerate(kept):
        os.symlink((a.log / "velodyne" / f"{scan:06d}.bin").resolve(), a.cut / "velodyne" / f"{number:06d}.bin")
    (a.cut / "times.txt").write_text("".join(f"{stamp:.6f}\n" for _, stamp in kept))
    (a.cut / "poses.txt").write_text("".join(poses[scan] + "\n" for scan, _ in kept))
    for name in ("calib.txt", "sweep.txt"):
        shutil.copy(a.log / name, a.cut / name)
    print(f"{a.cut}: {len(kept)} of {len(stamps)} scans, cuts of {', '.join(f'{c:g}' for c in cuts)} s, "
          f"the weakest tie between segments has {tie} scans")


if __name__ == "__main__":
    main()
