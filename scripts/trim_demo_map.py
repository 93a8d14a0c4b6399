#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""trim_demo_map.py RUN: leaves out of a run what relocalization does not need and what is large, and takes it out of
manifest.json too."""
import json
import sys
from pathlib import Path

# The state of the odometry serves --resume only; the rest are products that loopmark loops makes again.
LEFT_OUT = ("records/odometry.state", "report.html", "map.ot", "map.simplemap", "map.3Dscene", "cloud.ply")


def main():
    run = Path(sys.argv[1])
    manifest = json.loads((run / "manifest.json").read_text())
    for name in LEFT_OUT:
        (run / name).unlink(missing_ok=True)
        manifest["sha256"].pop(name, None)
    (run / "manifest.json").write_text(json.dumps(manifest, indent=1) + "\n")


if __name__ == "__main__":
    main()
