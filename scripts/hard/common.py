# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts that hurt loopmark share: small logs and runs, running it under limits, comparing folders."""

import hashlib
import os
import resource
import shutil
import signal
import subprocess
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent.parent
# Files that tell times or arguments, or that repeat what was read twice: they differ from run to run.
TELL_TIMES = {"manifest.json", "timings.json", "report.html", "job.json", "inputs.rec", "odometry.state",
              "odometry.state.before", "summary.json", "times.csv", "1-of-1.times"}


def program():
    """The program to be hurt: LOOPMARK, or the one in build/release."""
    path = Path(os.environ.get("LOOPMARK", SOURCE / "build/release/apps/loopmark/loopmark"))
    if not path.exists():
        raise SystemExit(f"{path} is not there: build it, or set LOOPMARK")
    return str(path)


def limit(memory_bytes):
    def apply():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if memory_bytes:
            resource.setrlimit(resource.RLIMIT_AS, (memory_bytes, memory_bytes))
    return apply


def run(arguments, timeout=120, memory_bytes=0, prefix=()):
    """(exit code, output); a code below 0 is a signal, None: it did not end in time."""
    process = subprocess.Popen([*prefix, program(), *map(str, arguments)], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, preexec_fn=limit(memory_bytes), start_new_session=True)
    try:
        output, _ = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
        return None, output.decode(errors="replace")
    return process.returncode, output.decode(errors="replace")


def must(arguments):
    code, output = run(arguments)
    if code != 0:
        raise SystemExit(f"loopmark {' '.join(map(str, arguments))}: exit {code}\n{output}")


def sums(folder):
    """SHA-256 of every file of a folder that does not tell times, as tables of an evaluation do."""
    result = {}
    for path in sorted(Path(folder).rglob("*")):
        if path.is_file() and path.name not in TELL_TIMES and path.parent.name != "tables":
            result[str(path.relative_to(folder))] = hashlib.sha256(path.read_bytes()).hexdigest()
    return result


def difference(a, b):
    """Names of files that differ between two results of sums()."""
    return sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))


def part_of_log(log, first, count, to):
    """A log of some scans of a simulated one."""
    (to / "velodyne").mkdir(parents=True)
    times = (log / "times.txt").read_text().splitlines()
    poses = (log / "poses.txt").read_text().splitlines()
    for i in range(first, first + count):
        shutil.copy(log / "velodyne" / f"{i:06d}.bin", to / "velodyne")
    (to / "times.txt").write_text("\n".join(times[first:first + count]) + "\n")
    (to / "poses.txt").write_text("\n".join(poses[first:first + count]) + "\n")
    for name in ("sweep.txt", "calib.txt"):
        shutil.copy(log / name, to)


def small_logs(work, scans=30):
    """Two logs of one street, which merge."""
    must(["simulate", "--length", 60, "--sensor", "vlp16", "-o", work / "town", "-q"])
    part_of_log(work / "town", 0, scans, work / "a")
    part_of_log(work / "town", 40, scans, work / "b")
    return work / "a", work / "b"
