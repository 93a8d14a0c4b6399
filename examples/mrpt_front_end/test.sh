#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
# Maps a small simulated rawlog with the example: test.sh LOOPMARK MRPT_FRONT_END
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" simulate -q -o "$work/drive" --format rawlog --compensated --sensor vlp16 --length 60
answer=$("$2" "$(find "$work/drive" -name '*.rawlog')" "$work/run")
echo "$answer"
[[ $answer =~ ^a\ CSimpleMap\ of\ [1-9][0-9]*\ keyframes$ ]]
if "$2" "$work/nowhere.rawlog" "$work/other"; then
  echo "a rawlog that is not there was taken" >&2
  exit 1
fi
