#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# From nothing to a map that is used: installs what is needed, builds, simulates a drive with a sparse sensor, maps it, says
# how far off it is with and without loops, and finds a sensor of another day that does not know where it is in the map.
#   scripts/demo.sh [FOLDER]              default: build/demo; what an earlier demo left there is replaced
# LOOPMARK_DEMO_LENGTH: driven distance in metres (default 900).
set -euo pipefail
# shellcheck source=scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

demo_dir=${1:-$source_dir/build/demo}
length=${LOOPMARK_DEMO_LENGTH:-900}
loopmark=$build_dir/apps/loopmark/loopmark
log=$build_dir/demo-build.log
mkdir -p "$build_dir" "$demo_dir"
demo_dir=$(cd "$demo_dir" && pwd)

step() { printf '\n== %s\n' "$*"; }

# Runs its arguments with the output in $log, and says every second or two how far they are.
with_progress() {
  "$@" >"$log" 2>&1 &
  local work=$! begun=$SECONDS line
  trap 'kill "$work" 2>/dev/null || true' INT TERM
  while kill -0 "$work" 2>/dev/null; do
    line=$(tail -n 1 "$log" | cut -c1-100)
    if [[ -t 1 ]]; then
      printf '\r\033[K%d s  %s' $((SECONDS - begun)) "$line"
      sleep 1
    else
      printf '%d s  %s\n' $((SECONDS - begun)) "$line"
      sleep 2
    fi
  done
  if [[ -t 1 ]]; then printf '\r\033[K'; fi
  wait "$work"
}

build() { configure -DLOOPMARK_BUILD_TESTS=OFF && build_target loopmark; }

# field FILE NAME: a number of a JSON file with a field a line.
field() { sed -n "s/^ *\"$2\": \([-0-9.e]*\),\?$/\1/p" "$1" | head -n 1; }

step "1/5 dependencies"
"$source_dir/scripts/install-dependencies.sh"

step "2/5 build (Release, $jobs jobs; output in $log)"
started=$SECONDS
if ! with_progress build; then
  tail -n 40 "$log" >&2
  echo "error: the build failed; the whole output is in $log" >&2
  exit 1
fi
echo "built in $((SECONDS - started)) s: $("$loopmark" --version)"

step "3/5 a simulated drive of $length m, 16 beams, five sweeps a second"
rm -rf "$demo_dir"/{drive,run,query,where,drive.partial,run.partial,query.partial,where.partial}
town=(--town 5 --sensor vlp16 --rate 5 --length "$length")
(set -x; "$loopmark" simulate -o "$demo_dir/drive" "${town[@]}")

step "4/5 its map"
(set -x; "$loopmark" map "$demo_dir/drive" -o "$demo_dir/run")
printf 'Position error (root mean square): %.3f m with odometry alone, %.3f m with loops.\n' \
  "$(field "$demo_dir/run/summary.json" ate_odometry_rmse_m)" "$(field "$demo_dir/run/summary.json" ate_rmse_m)"

step "5/5 another day, another lane: a kidnapped sensor, every 20th scan on its own, with no hint"
(set -x; "$loopmark" simulate -o "$demo_dir/query" "${town[@]}" --day 2 --seed 2 --lane left)
(set -x; "$loopmark" relocalize "$demo_dir/run" "$demo_dir/query" -o "$demo_dir/where" --single --every 20)

step "done in $SECONDS s"
printf '%-12s %s\n' \
  cloud "$demo_dir/run/cloud.ply" \
  map "$demo_dir/run/map.bt" \
  trajectory "$demo_dir/run/trajectory.tum" \
  where "$demo_dir/where/relocalization.csv"
printf '\nOpen this page in a browser:\n  file://%s\n' "$demo_dir/run/report.html"
