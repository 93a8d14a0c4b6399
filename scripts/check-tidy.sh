#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Holds the .cpp files that changed, and the headers they include, against .clang-tidy. Needs a configured build.
#   scripts/check-tidy.sh [--all] [FILE...]
# Exit code 1 where something is found. LOOPMARK_TIDY_SECONDS: after this time no further file is begun (default 600;
# with --all there is no end); those left out are named, and are no failure.
set -euo pipefail
# shellcheck source=scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
cd "$source_dir"

command -v clang-tidy >/dev/null || {
  echo "error: clang-tidy is missing; run scripts/install-dependencies.sh --checks" >&2
  exit 2
}
[[ -f "$build_dir/compile_commands.json" ]] || {
  echo "error: $build_dir is not configured; run scripts/test.sh first" >&2
  exit 2
}

seconds=${LOOPMARK_TIDY_SECONDS:-600}
case "${1:-}" in
  --all) seconds=${LOOPMARK_TIDY_SECONDS:-86400}
    mapfile -t files < <(scripts/changed-files.sh --all | grep '\.cpp$') ;;
  '') mapfile -t files < <(scripts/changed-files.sh | grep '\.cpp$') ;;
  *) files=("$@") ;;
esac
# Only what the build compiles: examples and benchmarks may be switched off.
mapfile -t files < <(for file in "${files[@]}"; do
  if grep -qF "$source_dir/$file\"" "$build_dir/compile_commands.json"; then echo "$file"; fi
done)
if [[ ${#files[@]} -eq 0 ]]; then
  echo "tidy: no file changed"
  exit 0
fi

export build_dir
LOOPMARK_TIDY_END=$(($(date +%s) + seconds))
export LOOPMARK_TIDY_END
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# shellcheck disable=SC2016 # expanded by the shells that xargs starts
printf '%s\n' "${files[@]}" | xargs -P "$jobs" -I{} bash -c '
  if [[ $(date +%s) -ge $LOOPMARK_TIDY_END ]]; then echo "skipped {}"; exit 0; fi
  findings=$(clang-tidy -p "$build_dir" --quiet --extra-arg=-Wno-error --extra-arg=-Wno-unknown-warning-option \
    "{}" 2>/dev/null) || echo "failed {}"
  if [[ -n "$findings" ]]; then echo "$findings"; fi' >"$log"

grep -v '^\(skipped\|failed\) ' "$log" | awk '!seen[$0]++' || true
failed=$(grep -c '^failed ' "$log" || true)
skipped=$(grep -c '^skipped ' "$log" || true)
sed -n 's/^failed /tidy: findings in /p' "$log"
sed -n "s/^skipped /tidy: not checked, as $seconds s were over: /p" "$log"
echo "tidy: ${#files[@]} files, $failed with findings, $skipped not checked"
[[ "$failed" -eq 0 ]]
