#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Three simulated drives of one town on three days, one in the opposite direction and one with another sensor, and one of
# another town: mapped one by one, merged with no idea of where they are; the foreign one must be left out.
#   benchmarks/merging.sh FOLDER          what is there already is not made again
# LOOPMARK_MERGING_LENGTH: metres of each drive (default 1200); LOOPMARK_MERGING_RATE: sweeps a second (10).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=scripts/lib.sh
source "$here/../scripts/lib.sh"
folder=${1:?usage: benchmarks/merging.sh FOLDER}
loopmark=${LOOPMARK:-$build_dir/apps/loopmark/loopmark}
size=(--length "${LOOPMARK_MERGING_LENGTH:-1200}" --rate "${LOOPMARK_MERGING_RATE:-10}")
mkdir -p "$folder"

drive() {
  local name=$1
  shift
  [[ -d $folder/$name ]] || "$loopmark" simulate -o "$folder/$name" "${size[@]}" "$@"
  [[ -f $folder/$name.truth ]] || "$here/town_truth.py" "$folder/$name" >"$folder/$name.truth"
  [[ -d $folder/run_$name ]] || "$loopmark" map "$folder/$name" -o "$folder/run_$name" --truth "$folder/$name.truth"
}
drive day1 --sensor hdl32e --day 1 --seed 1
drive day2 --sensor hdl32e --day 2 --seed 2 --direction reverse
drive day3 --sensor os1-64 --day 3 --seed 3
drive far --sensor hdl32e --town 7 --seed 4

rm -rf "$folder/town"
"$loopmark" merge "$folder/run_far" "$folder/run_day2" "$folder/run_day3" "$folder/run_day1" -o "$folder/town" --one-frame

python3 - "$folder" <<'PYTHON'
import json, sys
s = json.load(open(f"{sys.argv[1]}/town/summary.json"))
left_out = [d["name"] for d in s["drives"] if not d["belongs"]]
good = left_out == ["run_far"] and s["components"] == 1 and s["ate_rmse_m"] <= 0.25
print(f"{s['scans']} scans, {s['components']} components, left out: {left_out}, ATE of the whole {s['ate_rmse_m']:.3f} m "
      f"(at most 0.25): {'good' if good else 'NOT GOOD'}")
sys.exit(0 if good else 1)
PYTHON
