#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Power cuts: records every write of a map, rebuilds what a disk may hold after a cut, and resumes from it.

usage: power_cuts.py [--cuts N] [--seed S] [--scans N]

Needs strace. After a cut a file holds what was synced, and of what was written since any beginning, torn or as zeros; a
folder holds the names that were synced, and of the changes since any beginning. Then loopmark map --resume (or map, where
no run is left) must give the bytes of a run without cuts, or say with exit code 2 what is missing.
"""

import argparse
import os
import random
import re
import shutil
import sys
import tempfile
from pathlib import Path

import common

CALLS = ("openat,open,creat,write,pwrite64,writev,rename,renameat,renameat2,unlink,unlinkat,mkdir,mkdirat,rmdir,"
         "ftruncate,truncate,fsync,fdatasync,syncfs,close,link,linkat,lseek,dup,dup2,dup3")
STRING = re.compile(r'"((?:\\x[0-9a-f]{2})*)"')


class Inode:
    """A file or folder: what is on the disk for sure, and what came since."""

    def __init__(self, folder=False):
        self.folder = folder
        self.safe = {} if folder else b""
        self.since = []  # folders: (name, inode or None); files: functions from bytes to bytes with a tear

    def sync(self):
        self.safe = self.after(len(self.since))
        self.since = []

    def after(self, count, torn=None):
        """With the first `count` changes, and of the next one `torn` of its bytes."""
        state = dict(self.safe) if self.folder else self.safe
        for change in self.since[:count]:
            state = self.changed(state, change, None)
        if torn is not None and not self.folder and count < len(self.since):
            state = self.changed(state, self.since[count], torn)
        return state

    def changed(self, state, change, torn):
        if self.folder:
            name, inode = change
            state = dict(state)
            if inode is None:
                state.pop(name, None)
            else:
                state[name] = inode
            return state
        kind, at, data = change
        if kind == "cut":
            return state[:at] + b"\0" * (at - len(state))
        if torn is not None:
            share, zeros = torn
            data = b"\0" * len(data) if zeros else data[:int(share * len(data))]
        state += b"\0" * (at - len(state))
        return state[:at] + data + state[at + len(data):]


class Disk:
    """Follows the calls below one folder."""

    def __init__(self, root):
        self.root, self.top = str(root), Inode(folder=True)
        self.now = {str(root): self.top}  # path -> inode, as the program sees it
        self.open = {}  # descriptor -> [inode, offset, append]

    def ours(self, path):
        return path == self.root or path.startswith(self.root + "/")

    def enter(self, path, inode):
        self.now[path] = inode
        folder, name = os.path.split(path)
        self.now[folder].since.append((name, inode))

    def leave(self, path):
        self.now.pop(path)
        folder, name = os.path.split(path)
        self.now[folder].since.append((name, None))

    def opened(self, path, flags, descriptor):
        self.open.pop(descriptor, None)
        if not self.ours(path) or descriptor < 0:
            return
        if path not in self.now:
            if "O_CREAT" not in flags:
                return
            self.enter(path, Inode())
        inode = self.now[path]
        if "O_TRUNC" in flags:
            inode.since.append(("cut", 0, b""))
        self.open[descriptor] = [inode, 0, "O_APPEND" in flags]

    def written(self, descriptor, data, at=None):
        if descriptor in self.open:
            inode, offset, append = self.open[descriptor]
            end = len(inode.after(len(inode.since))) if append else offset
            place = end if at is None else at
            inode.since.append(("data", place, data))
            if at is None:
                self.open[descriptor][1] = place + len(data)

    def renamed(self, old, new, exchange):
        if not self.ours(old):
            return
        moved = {path: inode for path, inode in self.now.items() if path == old or path.startswith(old + "/")}
        other = {path: inode for path, inode in self.now.items() if path == new or path.startswith(new + "/")}
        for path in {**moved, **(other if exchange or new in self.now else {})}:
            self.now.pop(path)
        for a, b, entries in [(old, new, moved)] + ([(new, old, other)] if exchange else []):
            for path, inode in entries.items():
                self.now[b + path[len(a):]] = inode
        folder, name = os.path.split(new)
        self.now[folder].since.append((name, moved[old]))
        folder, name = os.path.split(old)
        self.now[folder].since.append((name, other[new] if exchange else None))

    def synced(self, descriptor):
        if descriptor in self.open:
            self.open[descriptor][0].sync()

    def synced_all(self):
        for inode in list(self.now.values()):
            inode.sync()


def text(quoted):
    return bytes.fromhex(quoted.replace("\\x", "")).decode(errors="surrogateescape")


def whole_lines(lines):
    """Calls that strace tells in two lines, put together; in the order in which they ended."""
    begun = {}
    for line in lines:
        pid, _, call = line.partition(" ")
        call = call.strip()
        if call.endswith("<unfinished ...>"):
            begun[pid] = call[:-len("<unfinished ...>")]
        elif call.startswith("<... "):
            yield begun.pop(pid, "") + call[call.index("resumed>") + len("resumed>"):]
        else:
            yield call


def replayed(disk, call, directory):
    """Applies one line of strace; True when it changed the disk."""
    match = re.match(r"(\w+)\((.*)\)\s+= (-?\d+)", call, re.S)
    if not match or int(match.group(3)) < 0:
        return False
    name, arguments, result = match.group(1), match.group(2), int(match.group(3))
    strings = [os.path.normpath(os.path.join(directory, text(s))) for s in STRING.findall(arguments)] \
        if not name.startswith(("write", "pwrite")) else []
    number = re.match(r"(\d+)", arguments)
    descriptor = int(number.group(1)) if number else -1
    if name in ("openat", "open", "creat"):
        disk.opened(strings[0], arguments + ("O_CREAT|O_TRUNC" if name == "creat" else ""), result)
    elif name in ("write", "pwrite64"):
        data = bytes.fromhex(STRING.search(arguments).group(1).replace("\\x", ""))[:result]
        disk.written(descriptor, data, int(arguments.rsplit(",", 1)[1]) if name == "pwrite64" else None)
    elif name == "writev":
        data = b"".join(bytes.fromhex(s.replace("\\x", "")) for s in STRING.findall(arguments))[:result]
        disk.written(descriptor, data)
    elif name.startswith("rename"):
        disk.renamed(strings[0], strings[1], "EXCHANGE" in arguments)
    elif name in ("unlink", "unlinkat", "rmdir"):
        if strings[0] in disk.now:
            disk.leave(strings[0])
    elif name in ("mkdir", "mkdirat"):
        if disk.ours(strings[0]):
            disk.enter(strings[0], Inode(folder=True))
    elif name in ("link", "linkat"):
        if disk.ours(strings[1]) and strings[0] in disk.now:
            disk.enter(strings[1], disk.now[strings[0]])
    elif name == "ftruncate" and descriptor in disk.open:
        disk.open[descriptor][0].since.append(("cut", int(arguments.rsplit(",", 1)[1]), b""))
    elif name in ("fsync", "fdatasync"):
        disk.synced(descriptor)
    elif name == "syncfs":
        disk.synced_all()
    elif name == "lseek" and descriptor in disk.open:
        disk.open[descriptor][1] = result
    elif name.startswith("dup") and descriptor in disk.open:
        disk.open[result] = disk.open[descriptor]
    elif name == "close":
        disk.open.pop(descriptor, None)
        return False
    return True


def laid_out(inode, path, rng):
    """Writes what a disk may hold of a folder."""
    path.mkdir()
    for name, entry in inode.after(rng.randint(0, len(inode.since))).items():
        if entry.folder:
            laid_out(entry, path / name, rng)
        else:
            torn = (rng.random(), rng.random() < 0.3) if rng.random() < 0.5 else None
            (path / name).write_bytes(entry.after(rng.randint(0, len(entry.since)), torn))


def traced(work, arguments):
    log = work / "trace"
    code, output = common.run(arguments, prefix=["strace", "-f", "-qq", "-xx", "-s", "1000000000", "-o", str(log), "-e",
                                                 f"trace={CALLS}"], timeout=600)
    if code != 0:
        raise SystemExit(f"the run to be recorded ended with {code}\n{output}")
    return list(whole_lines(log.read_text(errors="surrogateescape").splitlines()))


def resumed(out, log):
    """(exit code, output) of what a person would do after the cut."""
    if out.exists():
        return 0, "whole"
    if Path(f"{out}.partial").exists():
        code, output = common.run(["map", "--resume", out, "-q"])
        if code == 0 or "there is no interrupted run" not in output:
            return code, output
        shutil.rmtree(f"{out}.partial")
    return common.run(["map", log, "-o", out, "-q"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cuts", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scans", type=int, default=12)
    parser.add_argument("--set", action="append", default=[], help="an option of the run, as for loopmark --set")
    options = parser.parse_args()
    if not shutil.which("strace"):
        print("power_cuts: strace is not installed: skipped")
        return 77
    rng = random.Random(options.seed)
    settings = [word for setting in options.set for word in ("--set", setting)]
    with tempfile.TemporaryDirectory(prefix="loopmark_cuts_") as folder:
        work = Path(folder).resolve()
        log, _ = common.small_logs(work, options.scans)
        disk_folder = work / "disk"
        disk_folder.mkdir()
        calls = traced(work, ["map", log, "-o", disk_folder / "run", "-q", *settings])
        expected = common.sums(disk_folder / "run")
        points = sorted(rng.randrange(len(calls)) for _ in range(options.cuts))
        disk, outcomes, bad = Disk(disk_folder), {"same bytes": 0, "clear error": 0}, 0
        for number, call in enumerate(calls):
            for _ in range(points.count(number)):
                shutil.rmtree(disk_folder, ignore_errors=True)
                laid_out(disk.top, disk_folder, rng)
                was_whole = (disk_folder / "run").exists()
                code, output = resumed(disk_folder / "run", log)
                if code == 2:
                    outcomes["clear error"] += 1
                    print(f"cut at call {number} of {len(calls)}: {output.strip()[-300:]}", flush=True)
                    continue
                differing = ["exit " + str(code)] if code != 0 else common.difference(
                    expected, common.sums(disk_folder / "run"))
                outcomes["same bytes"] += 0 if differing else 1
                if differing:
                    bad += 1
                    print(f"cut at call {number} of {len(calls)}{' (the run was whole)' if was_whole else ''}: "
                          f"{', '.join(differing)}\n{output.strip()[-300:]}", flush=True)
            replayed(disk, call, os.getcwd())
        told = ", ".join(f"{count} {name}" for name, count in outcomes.items())
        print(f"{options.cuts} cuts over {len(calls)} calls: {told}, {bad} problems")
        return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
