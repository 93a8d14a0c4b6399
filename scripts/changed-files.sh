#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Prints the C++ files that differ from the base, one a line, or all of them with --all.
# The base: $LOOPMARK_BASE, else where this branch left origin/main or main, else the commit before this one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

patterns=('apps/*.cpp' 'apps/*.hpp' 'libs/*.cpp' 'libs/*.hpp' 'tests/*.cpp' 'tests/*.hpp'
  'benchmarks/*.cpp' 'benchmarks/*.hpp' 'examples/*.cpp' 'examples/*.hpp')

base() {
  local head candidate fork
  head=$(git rev-parse HEAD)
  for candidate in ${LOOPMARK_BASE:-} origin/main main; do
    fork=$(git merge-base HEAD "$candidate" 2>/dev/null) || continue
    if [[ "$fork" != "$head" ]]; then
      echo "$fork"
      return
    fi
  done
  git rev-parse --verify --quiet HEAD^ || true
}

commit=
if [[ "${1:-}" != --all ]]; then
  commit=$(base)
fi
if [[ -n "$commit" ]]; then
  { git diff --name-only --diff-filter=d "$commit" -- "${patterns[@]}"
    git ls-files --others --exclude-standard -- "${patterns[@]}"; } | sort -u
else
  git ls-files -- "${patterns[@]}"
fi
