#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# A simulated drive with revisits, whole and cut five times (5 to 60 s) with one jump: does the map heal, and how far is
# it from the truth?
#   benchmarks/healing.sh FOLDER          what is there already is not made again
# LOOPMARK_HEALING_LENGTH: metres (default 3000); LOOPMARK_HEALING_SENSOR (hdl64e); LOOPMARK_HEALING_RATE: Hz (10);
# LOOPMARK_HEALING_TOWN (401).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=scripts/lib.sh
source "$here/../scripts/lib.sh"
folder=${1:?usage: benchmarks/healing.sh FOLDER}
loopmark=${LOOPMARK:-$build_dir/apps/loopmark/loopmark}
mkdir -p "$folder"

[[ -d $folder/drive ]] || "$loopmark" simulate -o "$folder/drive" --length "${LOOPMARK_HEALING_LENGTH:-3000}" \
  --sensor "${LOOPMARK_HEALING_SENSOR:-hdl64e}" --rate "${LOOPMARK_HEALING_RATE:-10}" --town "${LOOPMARK_HEALING_TOWN:-401}"
[[ -d $folder/cut ]] || "$here/cut_log.py" "$folder/drive" "$folder/cut"
for log in drive cut; do
  [[ -d $folder/run_$log ]] || "$loopmark" map "$folder/$log" -o "$folder/run_$log"
done

python3 - "$folder" <<'PYTHON'
import json, sys
whole, cut = (json.load(open(f"{sys.argv[1]}/run_{log}/summary.json")) for log in ("drive", "cut"))
for name, s in (("whole", whole), ("cut", cut)):
    print(f"{name:6} {s['scans']:6} scans, {s['parts'][0]['pieces']:2} pieces in main, {s['components']} components, "
          f"{s['loops']} loops of {s['candidates']}, ATE {s['ate_rmse_m']:.3f} m")
ratio = cut["ate_rmse_m"] / whole["ate_rmse_m"]
healed = cut["components"] == 1 and ratio <= 1.5
print(f"ratio {ratio:.2f} (at most 1.5): {'healed' if healed else 'NOT HEALED'}")
sys.exit(0 if healed else 1)
PYTHON
