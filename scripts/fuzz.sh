#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Fuzzes every reader with libFuzzer under the address and undefined-behaviour sanitizers (clang 14), in build/fuzz.
#   scripts/fuzz.sh HOURS [TARGET ...]       HOURS for each target; 0.005 is 18 seconds
# What is found lies in build/fuzz/findings/TARGET; once it is mended, put it into fuzz/seeds/TARGET, which the tests
# replay. What the fuzzers learn is kept in build/fuzz/corpus. LOOPMARK_JOBS: how many targets at a time.
set -euo pipefail
hours=${1:?usage: scripts/fuzz.sh HOURS [TARGET ...]}
shift
LOOPMARK_BUILD_DIR=${LOOPMARK_FUZZ_DIR:-$(dirname "${BASH_SOURCE[0]}")/../build/fuzz}
# shellcheck source=scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

if ! command -v clang++ >/dev/null && ! command -v clang++-14 >/dev/null; then
  echo "fuzz: clang is not installed (scripts/install-dependencies.sh --fuzz)" >&2
  exit 77
fi
cxx=$(command -v clang++-14 || command -v clang++)
mapfile -t targets < <(if [[ $# -gt 0 ]]; then printf '%s\n' "$@"; else
  for file in "$source_dir"/fuzz/targets/*.cpp; do basename "$file" .cpp; done; fi)

sanitizers="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer"
configure -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="${cxx/++/}" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DCMAKE_CXX_FLAGS="$sanitizers -O1 -Wno-error" -DLOOPMARK_BUILD_TESTS=OFF -DLOOPMARK_BUILD_EXAMPLES=OFF \
  -DLOOPMARK_BUILD_FUZZERS=ON >/dev/null
cmake --build "$build_dir" --parallel "$jobs" --target "${targets[@]/#/fuzz_}"

seconds=$(awk -v h="$hours" 'BEGIN { s = int(h * 3600); print s < 1 ? 1 : s }')
one() {
  local name=$1 corpus=$build_dir/corpus/$1 findings=$build_dir/findings/$1 dictionary=()
  mkdir -p "$corpus" "$findings"
  [[ -f $source_dir/fuzz/dictionaries/$name.dict ]] && dictionary=(-dict="$source_dir/fuzz/dictionaries/$name.dict")
  local log=$build_dir/$name.log status=0
  "$build_dir/fuzz/fuzz_$name" "${dictionary[@]}" -max_total_time="$seconds" -max_len=65536 -rss_limit_mb=4096 \
    -malloc_limit_mb=2500 -timeout=20 -print_final_stats=1 -artifact_prefix="$findings/" \
    "$corpus" "$source_dir/fuzz/seeds/$name" >"$log" 2>&1 || status=$?
  local runs
  runs=$(awk '/number_of_executed_units/ { print $2 }' "$log")
  if [[ $status -eq 0 ]]; then
    echo "$name: ${runs:-?} executions, no finding"
  else
    echo "$name: FINDING after ${runs:-?} executions, see $log and $findings"
    grep -E "SUMMARY|ERROR|runtime error|what\(\)" "$log" | head -3
  fi
  return $status
}
export -f one
export build_dir source_dir seconds
printf '%s\n' "${targets[@]}" | xargs -P "$jobs" -I{} bash -c 'one "$1"' _ {}
