#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# From nothing to a map: installs what is needed, builds, simulates a short drive, maps it, says where the results are.
#   scripts/demo.sh [FOLDER]              default: build/demo; what an earlier demo left there is replaced
# LOOPMARK_DEMO_LENGTH: driven distance in metres (default 300).
set -euo pipefail
# shellcheck source=scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

demo_dir=${1:-$source_dir/build/demo}
length=${LOOPMARK_DEMO_LENGTH:-300}
loopmark=$build_dir/apps/loopmark/loopmark
log=$build_dir/demo-build.log
mkdir -p "$build_dir" "$demo_dir"

step() { printf '\n== %s\n' "$*"; }

step "1/4 dependencies"
"$source_dir/scripts/install-dependencies.sh"

step "2/4 build (Release, $jobs jobs; output in $log)"
started=$SECONDS
if ! { configure -DLOOPMARK_BUILD_TESTS=OFF && build_target loopmark; } >"$log" 2>&1; then
  tail -n 40 "$log" >&2
  echo "error: the build failed; the whole output is in $log" >&2
  exit 1
fi
echo "built in $((SECONDS - started)) s: $("$loopmark" --version)"

step "3/4 a simulated drive of $length m"
rm -rf "$demo_dir/drive" "$demo_dir/drive.partial" "$demo_dir/run" "$demo_dir/run.partial"
(set -x; "$loopmark" simulate -o "$demo_dir/drive" --length "$length" --sensor hdl32e)

step "4/4 its map"
(set -x; "$loopmark" map "$demo_dir/drive" -o "$demo_dir/run")

step "done in $SECONDS s"
printf '%-12s %s\n' \
  map "$demo_dir/run/map.bt" \
  cloud "$demo_dir/run/cloud.ply" \
  trajectory "$demo_dir/run/trajectory.tum" \
  report "$demo_dir/run/report.html"
