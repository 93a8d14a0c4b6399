#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Makes maps/demo and maps/demo-query anew: a simulated VLP-16 drive as a small map, and four scans of another day in it.
#   scripts/make-demo-map.sh [LOOPMARK]      default: that of build/release
# Needs Python 3 and nothing else; takes about a minute on one core. Run it when a version refuses the map that is there.
set -euo pipefail
# shellcheck source=scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
loopmark=$(realpath "${1:-$build_dir/apps/loopmark/loopmark}")
work=/tmp/loopmark-demo-map # a fixed name: the run keeps it as the path of its log

rm -rf "$work"
mkdir -p "$work"
cd "$work"
"$loopmark" simulate -o drive --town 7 --length 150 --sensor vlp16
"$loopmark" simulate -o other-day --town 7 --length 150 --sensor vlp16 --day 2 --seed 2 --lane left

# Fewer keyframes with fewer points than by default keep the map small enough for a repository.
"$loopmark" map drive -o demo --set slam.keyframe_m=10 --set slam.keyframe_voxel_m=0.5 --set slam.cloud_voxel_m=0.5 \
  --set occupancy.resolution_m=0.5
python3 "$source_dir/scripts/trim_demo_map.py" demo
python3 "$source_dir/scripts/cut_demo_query.py" other-day drive query

rm -rf "$source_dir/maps/demo" "$source_dir/maps/demo-query"
cp -r demo "$source_dir/maps/demo"
cp -r query "$source_dir/maps/demo-query"
cd "$source_dir"
rm -rf "$work"
du -sh maps/demo maps/demo-query
