#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Hurts the program in every way that is known, for some minutes. SCALE=20 for a night.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
scale=${SCALE:-1}
status=0
python3 kills.py --kills $((50 * scale)) || status=1
python3 mutations.py --runs $((1000 * scale)) || status=1
python3 power_cuts.py --cuts $((50 * scale)) || [[ $? -eq 77 ]] || status=1
python3 faults.py --every $((scale > 20 ? 1 : 20 / scale)) || [[ $? -eq 77 ]] || status=1
exit $status
