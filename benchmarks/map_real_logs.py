#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Maps real logs and holds the trajectories against reference motions of scan pairs.

usage: map_real_logs.py --logs FOLDER --pairs FOLDER [--loopmark PROGRAM] [LOG...]

FOLDER/<log>/ are unpacked logs with poses.txt, the --pairs folder has pairs.txt and sessions.txt (as for loopmark
evaluate). A pair fails too when its scans ended in different components of the map. Exit code 1 where anything fails."""
import json
import statistics

import map_common as common

# log: within (metres, degrees), least share of pairs, median at most (metres), times real time at least
ASKED = {
    "kitti_raw_city": ((0.6, 5.0), 1.00, 0.10, 2.0),
    "mulran_riverside02_a": ((0.6, 5.0), 0.90, None, None),
    "mulran_riverside02_b": ((0.6, 5.0), 0.90, None, None),
    "balm_loop": ((0.3, 3.0), 0.95, None, None),
}
# A revisit: (scans that come back, scans they come back to), how far a loop may be off (metres)
REVISITS = {"balm_loop": ((range(91, 103), range(53, 69)), 0.5)}


def pairs_of(folder, log):
    sessions = dict(line.split()[:2] for line in (folder / "sessions.txt").read_text().splitlines()[1:])
    pairs = []
    for line in (folder / "pairs.txt").read_text().splitlines()[1:]:
        words = line.split()
        if sessions[words[0]] == log:
            m = [float(word) for word in words[3:15]]
            pairs.append((int(words[1]), int(words[2]), [m[0:4], m[4:8], m[8:12]]))
    return pairs


def judge_pairs(verdicts, run, pairs, asked):
    (metres, degrees), share, median, _ = asked
    poses = common.read_kitti(run / "trajectory.kitti")
    component = [row["component"] for row in common.table(run / "covariances.csv")]
    right, errors = 0, []
    for i, j, T in pairs:
        m, deg = common.difference(common.motion(poses, i, j), T)
        together = component[i] == component[j]
        right += together and m <= metres and deg <= degrees
        errors += [m] if together else []
    verdicts.line(right >= share * len(pairs), f"{right} of {len(pairs)} pairs within {metres} m and {degrees} deg "
                  f"(asked: {100 * share:.0f} %)")
    middle = statistics.median(errors)
    verdicts.line(median is None or middle <= median,
                  f"median error {middle:.3f} m{f' (asked: {median} m)' if median else ''}, largest {max(errors):.3f} m")


def judge_revisit(verdicts, run, log_folder, asked):
    (back, first), metres = asked
    truth = common.read_kitti(log_folder / "poses.txt")
    loops = common.accepted_loops(run)
    closing = [loop for loop in loops if loop[0] in back and loop[1] in first]
    verdicts.line(closing, f"revisit of scans {first[0]}-{first[-1]} by {back[0]}-{back[-1]}: {len(closing)} loops")
    off = [common.difference(T, common.motion(truth, source, target))[0] for source, target, T in loops]
    verdicts.line(max(off, default=0.0) <= metres,
                  f"{len(loops)} loops accepted, the worst {max(off, default=0.0):.3f} m off (asked: {metres} m)")


def judge(args, verdicts, log):
    run = args.work / "real" / log
    ran = common.run_map(args, args.logs / log, run)
    summary = json.loads((run / "summary.json").read_text())
    real_time = summary["duration_s"] / ran.seconds
    print(f"{log}: {ran.seconds:.1f} s ({real_time:.2f} times real time, {ran.cpu_s:.1f} s of CPU), {ran.peak_mb:.0f} MB, "
          f"{common.components(run)} components, {summary['recovered']} scans recovered, {summary['loops']} loops")
    scans = len((args.logs / log / "times.txt").read_text().split())
    posed = sum(not line.startswith("#") for line in (run / "trajectory.tum").read_text().splitlines())
    verdicts.line(posed == scans, f"{posed} of {scans} scans have a pose")
    asked = ASKED[log]
    judge_pairs(verdicts, run, pairs_of(args.pairs, log), asked)
    if asked[3]:
        verdicts.line(real_time >= asked[3], f"{real_time:.2f} times real time (asked: {asked[3]})")
    if log in REVISITS:
        judge_revisit(verdicts, run, args.logs / log, REVISITS[log])


def main():
    p = common.parser(__doc__)
    p.add_argument("--logs", required=True, type=common.Path, help="unpacked logs, by name")
    p.add_argument("--pairs", required=True, type=common.Path, help="pairs.txt and sessions.txt")
    p.add_argument("names", nargs="*", metavar="LOG", help=f"default: {', '.join(ASKED)}")
    args = p.parse_args()
    verdicts = common.Verdicts()
    for log in args.names or ASKED:
        judge(args, verdicts, log)
    verdicts.end()


if __name__ == "__main__":
    main()
