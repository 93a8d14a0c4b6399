#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Peak memory of `loopmark map` on a short and on a long simulated drive.

usage: map_memory.py [--short 1000] [--long 5000] [--sensor hdl64e] [--route explore] [--loopmark PROGRAM]

Both drives are through one town that is large enough for the long one (12 x 10 blocks). Exit code 1 where the long
drive takes more than 1.3 times the memory of the short one, or 2 GiB. Drives are kept for the next time: 5 km of HDL-64E
take about 15 GB."""
import json

import map_common as common


def main():
    p = common.parser(__doc__)
    p.add_argument("--short", default=1000)
    p.add_argument("--long", default=5000)
    p.add_argument("--sensor", default="hdl64e")
    p.add_argument("--route", default="explore")
    p.add_argument("--set", action="append", default=[], metavar="A.B=C", help="options of loopmark map")
    args = p.parse_args()
    town = ["--set", "simulation.town.columns=12", "--set", "simulation.town.rows=10"]
    settings = [word for value in args.set for word in ("--set", value)]
    peaks = []
    for length in (args.short, args.long):
        name = f"{args.route}-{args.sensor}-{length}"
        drive = common.simulated(args, name, "--length", length, "--sensor", args.sensor, "--route", args.route, *town)
        ran = common.run_map(args, drive, args.work / "memory" / name, *settings)
        s = json.loads((args.work / "memory" / name / "summary.json").read_text())
        peaks.append(ran.peak_mb)
        print(f"{name}: {s['path_m']:.0f} m, {s['scans']} scans, {s['keyframes']} keyframes, {s['loops']} loops, "
              f"{ran.seconds:.0f} s, peak {ran.peak_mb:.0f} MB", flush=True)
    verdicts = common.Verdicts()
    verdicts.line(peaks[1] <= 1.3 * peaks[0], f"{peaks[1] / peaks[0]:.2f} times the memory (asked: 1.3)")
    verdicts.line(peaks[1] < 2048, f"{peaks[1]:.0f} MB (asked: 2048 MB)")
    verdicts.end()


if __name__ == "__main__":
    main()
