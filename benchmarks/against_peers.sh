#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Everything beside Open3D and PCL (Debian's packages), on one machine, in one run:
#   1. the engine and their whole pipelines, from raw scans to a motion: recall by overlap with Wilson intervals, false
#      answers, times; on natural and perturbed pairs and negatives
#   2. estimators on the same matches
#   3. descriptors and matching: how many times faster
#
#   benchmarks/against_peers.sh SET_FOLDER LOGS OUT [PCL_EVERY [MATCHES_EVERY]]
#
# SET_FOLDER has pairs.txt, sessions.txt and, where there are any, negatives.txt, pairs_perturbed.txt, perturb.txt; LOGS has
# the logs that sessions.txt names. PCL takes minutes for a few pairs: it gets every PCL_EVERY-th one (10), in a table of its
# own beside the others on the same pairs. MATCHES_EVERY: of the pairs of part 2 (5). What was stopped goes on where it was.
# LOOPMARK_BENCH_SCANS=a.pcd,b.pcd names two scans for part 3, which else takes two made-up yards.
set -euo pipefail
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/../scripts/lib.sh"

if [[ $# -lt 3 ]]; then
  sed -n '5,16p' "$0" >&2
  exit 2
fi
set_folder=$1 logs=$2 out=$3
pcl_every=${4:-10} matches_every=${5:-5}
programs=$build_dir/benchmarks
for program in engine_and_peers same_matches bench_features; do
  if [[ ! -x $programs/$program ]]; then
    echo "$programs/$program is not built: cmake with -DLOOPMARK_BUILD_BENCHMARKS=ON, then build $program" >&2
    exit 2
  fi
done
mkdir -p "$out"

echo "# Engine and Open3D, all pairs"
"$programs/engine_and_peers" "$set_folder" "$logs" "$out/open3d" 1 open3d
echo "# The same and PCL, every $pcl_every-th pair"
"$programs/engine_and_peers" "$set_folder" "$logs" "$out/pcl-every-$pcl_every" "$pcl_every" open3d,pcl

echo "# Estimators on the same matches, every $matches_every-th pair"
"$programs/same_matches" "$set_folder/pairs.txt" "$logs" "$set_folder/sessions.txt" "$matches_every" ground

echo "# Descriptors and matching: processor time of the peer over ours, one thread"
"$programs/bench_features" --benchmark_filter='/1/process_time' --benchmark_min_time=2 2>/dev/null >"$out/features.txt"
awk '/process_time/ { sub(/\/.*/, "", $1); cpu[$1] = $4 }
  END { printf "FPFH: %.0f ms against %.0f ms of PCL: %.1f times\n", cpu["ours_fpfh"], cpu["pcl_fpfh"],
          cpu["pcl_fpfh"] / cpu["ours_fpfh"];
        printf "two nearest, both ways: %.0f ms against %.0f ms of FLANN: %.1f times\n", cpu["ours_nearest_two"],
          cpu["flann_nearest_two"], cpu["flann_nearest_two"] / cpu["ours_nearest_two"] }' "$out/features.txt"
