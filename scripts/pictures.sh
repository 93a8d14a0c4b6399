#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Makes the pictures of the documentation from a run, so that they show the program as it is.
#   scripts/pictures.sh [RUN]             default: the run of scripts/demo.sh, which is made when it is not there
set -euo pipefail
# shellcheck source=scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run=${1:-$source_dir/build/demo/run}
web=$build_dir/web
pictures=$source_dir/docs/pictures
chromium=$(command -v chromium || true)
if [[ -z "$chromium" ]]; then
  echo "error: no Chromium; install it with: scripts/install-dependencies.sh --checks" >&2
  exit 2
fi
if [[ ! -f "$run/report.html" ]]; then
  "$source_dir/scripts/demo.sh"
fi
if [[ ! -d "$web/node_modules/playwright-core" ]]; then
  echo "error: the browser's driver is missing; configure with -DLOOPMARK_BUILD_TESTS=ON" >&2
  exit 2
fi
rm -rf "$web/tests"
cp -r "$source_dir/web/tests" "$web/tests"
mkdir -p "$pictures"

# picture NAME WIDTH HEIGHT light|dark FRAGMENT
picture() {
  node "$web/tests/look.mjs" "$chromium" "$run/report.html" "$pictures/$1.jpg" "$2" "$3" "$4" "$5" window >/dev/null
  echo "$pictures/$1.jpg"
}

# The accepted loop whose ends are driven farthest apart.
loop=$(awk -F, 'NR > 1 && $6 == 1 && $1 - $2 > most { most = $1 - $2; loop = $1 "-" $2 } END { print loop }' "$run/loops.csv")
picture map 1400 860 dark ""
picture loop 1400 860 light "#loop=$loop"
picture narrow 390 800 light ""
