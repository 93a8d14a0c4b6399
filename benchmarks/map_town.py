#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Maps a simulated tour with and without its loops: revisits closed, false loops, what the loops are worth.

usage: map_town.py [--length 1500] [--sensor hdl64e] [--town 1] [--loopmark PROGRAM]

A loop is false when its motion is over 0.6 m or 5 deg from the truth. Exit code 1 where something asked for fails."""
import json

import map_common as common


NEAR = 12  # scans: a crossing is 7 m long and keyframes stand metres apart, so its loops may begin beside it


def closed_by(revisit, loops):
    """How many loops join the stretch to the earlier one."""
    back = range(int(revisit["first_scan"]) - NEAR, int(revisit["last_scan"]) + 1 + NEAR)
    first = range(int(revisit["earlier_first_scan"]) - NEAR, int(revisit["earlier_last_scan"]) + 1 + NEAR)
    return sum((s in back and t in first) or (t in back and s in first) for s, t, _ in loops)


def judge_revisits(verdicts, drive, loops):
    revisits = common.table(drive / "revisits.csv")
    kinds = [revisit["kind"] for revisit in revisits]
    verdicts.line(len(kinds) >= 6 and kinds.count("opposite") >= 2 and "crossing" in kinds,
                  f"{len(kinds)} revisits, {kinds.count('opposite')} in the opposite direction, "
                  f"{kinds.count('crossing')} crossing (asked: 6, 2, 1)")
    for revisit in revisits:
        count = closed_by(revisit, loops)
        alike = ", on the blocks that look alike" if revisit["near_identical"] == "1" else ""
        verdicts.line(count, f"{revisit['kind']}, scans {revisit['first_scan']}-{revisit['last_scan']} over "
                      f"{revisit['earlier_first_scan']}-{revisit['earlier_last_scan']}{alike}: {count} loops")


def judge_loops(verdicts, drive, loops):
    truth = common.read_kitti(drive / "poses.txt")
    off = sorted(((*common.difference(T, common.motion(truth, s, t)), s, t) for s, t, T in loops), reverse=True)
    false = [loop for loop in off if loop[0] > 0.6 or loop[1] > 5.0]
    verdicts.line(not false, f"{len(false)} of {len(loops)} accepted loops false")
    for metres, degrees, source, target in off[:3]:
        print(f"        {source}-{target}: {metres:.3f} m, {degrees:.2f} deg off")
    if off:
        degrees = sorted(loop[1] for loop in off)
        print(f"        median {off[len(off) // 2][0]:.3f} m, {degrees[len(degrees) // 2]:.3f} deg off")


def main():
    p = common.parser(__doc__)
    p.add_argument("--length", default=1500)
    p.add_argument("--sensor", default="hdl64e")
    p.add_argument("--town", default=1)
    p.add_argument("--set", action="append", default=[], metavar="A.B=C", help="options of loopmark map")
    args = p.parse_args()
    name = f"tour-{args.town}-{args.sensor}-{args.length}"
    drive = common.simulated(args, name, "--town", args.town, "--length", args.length, "--sensor", args.sensor)
    settings = [word for value in args.set for word in ("--set", value)]
    runs, summaries = {}, {}
    for kind, more in (("with", []), ("without", ["--set", "slam.close_loops=false"])):
        runs[kind] = args.work / "town" / f"{name}-{kind}"
        ran = common.run_map(args, drive, runs[kind], *settings, *more)
        s = summaries[kind] = json.loads((runs[kind] / "summary.json").read_text())
        print(f"{name} {kind} loops: {s['scans']} scans, {s['path_m']:.0f} m in {ran.seconds:.0f} s "
              f"({s['duration_s'] / ran.seconds:.2f} times real time), {ran.peak_mb:.0f} MB, ATE {s['ate_rmse_m']:.3f} m, "
              f"{common.components(runs[kind])} components", flush=True)
    verdicts = common.Verdicts()
    loops = common.accepted_loops(runs["with"])
    judge_revisits(verdicts, drive, loops)
    judge_loops(verdicts, drive, loops)
    ate, alone = summaries["with"]["ate_rmse_m"], summaries["without"]["ate_rmse_m"]
    verdicts.line(ate <= 0.20, f"ATE {ate:.3f} m (asked: 0.20 m)")
    verdicts.line(ate <= alone / 3, f"ATE with loops is {ate / alone:.2f} of that without, {alone:.3f} m (asked: 0.33)")
    verdicts.end()


if __name__ == "__main__":
    main()
