#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Maps a log with one thread and with two, each twice, and compares every file that the runs leave.

usage: map_same_bytes.py [LOG] [--loopmark PROGRAM]

Without LOG a simulated tour of 300 m is taken. manifest.json, timings.json and report.html tell times, records/job.json the
folder of the run: they may differ."""
import map_common as common


def main():
    p = common.parser(__doc__)
    p.add_argument("log", nargs="?", type=common.Path)
    args = p.parse_args()
    log = args.log or common.simulated(args, "same-bytes", "--length", 300, "--sensor", "hdl32e")
    verdicts, first = common.Verdicts(), None
    for threads in (1, 2):
        for time in (1, 2):
            run = args.work / "bytes" / f"{threads}-threads-{time}"
            args.threads = threads
            common.run_map(args, log, run)
            found = common.hashes(run)
            first = first or found
            differ = sorted(name for name in first.keys() | found.keys() if first.get(name) != found.get(name))
            verdicts.line(not differ, f"{threads} threads, run {time}: {len(found)} files, "
                          f"{len(differ)} differ from the first run's{': ' + ', '.join(differ[:5]) if differ else ''}")
    verdicts.end()


if __name__ == "__main__":
    main()
