#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the small seeds of fuzzing that loopmark itself writes; the others were written by hand or found.

usage: make_seeds.py LOOPMARK

Simulates a minute's log, maps and evaluates it, and keeps a few hundred bytes of each kind below fuzz/seeds.
"""

import io
import json
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

SEEDS = Path(__file__).resolve().parent / "seeds"


def keep(target, name, data):
    (SEEDS / target).mkdir(parents=True, exist_ok=True)
    (SEEDS / target / name).write_bytes(data if isinstance(data, bytes) else data.encode())


def pcd(data, body, size="4 4 4 4 2", count="1 1 1 1 1", points=2):
    return (f"VERSION 0.7\nFIELDS x y z intensity ring\nSIZE {size}\nTYPE F F F F U\nCOUNT {count}\nWIDTH {points}\n"
            f"HEIGHT 1\nPOINTS {points}\nDATA {data}\n").encode() + body


def point_files():
    points = struct.pack("<4fH", 1, 2, 3, .5, 7) + struct.pack("<4fH", 4, 5, 6, .5, 8)
    keep("point_file", "binary_pcd", b"\0" + pcd("binary", points))
    keep("point_file", "ascii_pcd", b"\0" + pcd("ascii", b"1 2 3 0.5 7\n4 5 6 0.5 8\n"))
    columns = struct.pack("<8f2H", 1, 4, 2, 5, 3, 6, .5, .5, 7, 8)
    packed = bytes([31]) + columns[:32] + bytes([len(columns) - 33]) + columns[32:]
    keep("point_file", "compressed_pcd",
         b"\0" + pcd("binary_compressed", struct.pack("<2I", len(packed), len(columns)) + packed))
    for data in ("ascii", "binary", "binary_compressed"):
        keep("point_file", f"{data}_that_wraps", b"\0" + pcd(data, points, count="1 1 1 1 65536", points=1 << 32))
    ply = "ply\nformat {} 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    keep("point_file", "ascii_ply", b"\1" + ply.format("ascii").encode() + b"1 2 3\n4 5 6\n")
    keep("point_file", "binary_ply", b"\1" + ply.format("binary_little_endian").encode() + struct.pack("<6f", *range(1, 7)))
    for columns in (4, 5, 6):
        keep("point_file", f"bin_{columns}", bytes([columns - 2]) + struct.pack(f"<{2 * columns}f", *range(2 * columns)))
    keep("point_file", "ring_that_is_none", b"\3" + struct.pack("<5f", 1, 2, 3, .5, float("nan")))


def npy(kind, shape, data):
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}"
    header += " " * (63 - (len(header) + 10) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header.encode() + data


def archives():
    for name, method in (("stored", zipfile.ZIP_STORED), ("deflated", zipfile.ZIP_DEFLATED)):
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w", method) as archive:
            archive.writestr("xyz.npy", npy("<f8", "(2, 3)", struct.pack("<6d", *range(6))))
            archive.writestr("features.npy", npy("<f4", "(2, 4)", struct.pack("<8f", *range(8))))
        keep("descriptors", name, content.getvalue())


def texts():
    keep("yaml", "options", "slam:\n  keyframe_m: 2.0\nlog: {rate_hz: 10}\nlist: [1, 2.5, x]\n")
    keep("yaml", "alias", "a: &a [1, 2]\nb: *a\n")
    keep("yaml", "alias_of_itself", "a: &a [*a]\n")
    keep("yaml", "aliases_that_multiply", "a: &a [x,x,x,x,x,x,x,x,x,x]\n" + "".join(
        f"{c}: &{c} [{','.join(['*' + p] * 10)}]\n" for p, c in zip("abcdefgh", "bcdefghi")))
    keep("pose_graph", "two", "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\nFIX 0\n# loop\n"
         "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 " + " ".join("1" if i in (0, 6, 11, 15, 18, 20) else "0" for i in range(21)) +
         "\n")
    keep("trajectory", "tum", "0.0 1 2 3 0 0 0 1\n0.1 1 2 3 0 0 0 1\n")
    keep("trajectory", "kitti", "1 0 0 0 0 1 0 0 0 0 1 0\n" * 3)
    keep("log_folder", "all", "0.0\n0.1\n0.2\n\0" + "1 0 0 0 0 1 0 0 0 0 1 0\n" * 3 +
         "\0Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n\0direction clockwise\nperiod_s 0.1\n")
    keep("log_folder", "comma", "0.0\n,\n0.2\n\0\0\0")
    keep("log_folder", "dates", "2011-09-26 13:02:25.9\n2011-09-26 13:02:26.0\n2011-09-26 13:02:26.1\n\0\0\0")


def states():
    pose = struct.pack("<16d", *(1.0 if i % 5 == 0 else 0.0 for i in range(16)))
    keep("saved_state", "fresh", struct.pack("<Q", 0x6F646F6D65747234) + pose + struct.pack("<Qd", 0, 0.1) +
         struct.pack("<Q", 0) + struct.pack("<3d", 0, 0, 0) + b"\0")
    keep("saved_state", "counts_without_end", struct.pack("<Q", 0x6F646F6D65747234) + pose +
         struct.pack("<QdQ", 0, 0.1, (1 << 64) - 1))


def what_loopmark_writes(program):
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)

        def loopmark(*words):
            subprocess.run([program, *map(str, words)], check=True, stdout=subprocess.DEVNULL)

        loopmark("simulate", "--length", 12, "--sensor", "vlp16", "-o", work / "log", "-q")
        loopmark("map", work / "log", "-o", work / "run", "-q")

        def lines(name, count):
            return b"\n".join(line[9:] for line in (work / "run/records" / name).read_bytes().split(b"\n")[:count])

        scans = lines("scans.rec", 6)
        pose = " ".join("0x1p+0" if k in (0, 5, 10) else "0x0p+0" for k in range(12))
        covariance = " ".join("0x1p-6" for _ in range(21))
        loop = f"1 0 place 1 0x1p-1 {pose} {covariance} 1 a 0x1p+0 ".encode()
        keep("run_records", "one_drive", scans + b"\0" + loop + b"\0" + b"0 6 abc day1 /log" + b"\0" + b"1 0 force")
        keep("run_records", "no_loops", scans + b"\0\0\0")
        keep("prepared_scan", "keyframe", (work / "run/keyframes/000000.prepared").read_bytes()[12:])
        keep("place_descriptor", "keyframe", (work / "run/keyframes/000000.place").read_bytes()[:-4])
        keep("place_descriptor", "short", b"LPS2" + struct.pack("<I4f", 4, .5, .5, .5, .5))
        loopmark("simulate", "--pairs", 2, "--negatives", 1, "--sensor", "vlp16", "-o", work / "pairs", "-q")
        sets = [path for path in (work / "pairs").glob("*.txt") if path.name in ("pairs.txt", "negatives.txt")]
        for path in sets:
            keep("pair_set", path.stem, path.read_bytes())
        loopmark("evaluate", work / "pairs/pairs.txt", "--data", work / "pairs", "-o", work / "result", "-q")
        keep("result_records", "experiment", (work / "result/experiment.json").read_bytes())
        record = (work / "result/shards/1-of-1.records").read_bytes().split(b"\n")[0][9:]
        keep("result_records", "outcome", record)
        keep("result_records", "times", (work / "result/shards/1-of-1.times").read_bytes().split(b"\n")[0][9:])
        keep("result_records", "outcome_of_a_pair_that_is_not_there",
             json.dumps({**json.loads(record), "pair": 99999999}))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    point_files()
    archives()
    texts()
    states()
    what_loopmark_writes(sys.argv[1])
