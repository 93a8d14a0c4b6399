#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
# Maps a short simulated drive and finds a rawlog of another day in it: test.sh LOOPMARK MRPT_RELOCALIZER
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
simulate=("$1" simulate -q --compensated --sensor vlp16 --rate 5 --length 50)
"${simulate[@]}" -o "$work/day1"
"$1" map -q "$work/day1" -o "$work/run" >"$work/map.log"
"${simulate[@]}" -o "$work/day2" --format rawlog --day 2 --seed 2
answer=$("$2" "$work/run" "$(find "$work/day2" -name '*.rawlog')")
echo "$answer"
grep -q '  tracking  P(correct) [01][.][0-9]*  \[' <<<"$answer"
if "$2" "$work/nowhere" "$(find "$work/day2" -name '*.rawlog')"; then
  echo "a run that is not there was taken" >&2
  exit 1
fi
