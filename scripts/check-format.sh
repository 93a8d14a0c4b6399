#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Holds the C++ files that changed against .clang-format.
#   scripts/check-format.sh [--all] [--fix]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mode=(--dry-run -Werror)
scope=()
for argument in "$@"; do
  case "$argument" in
    --fix) mode=(-i) ;;
    --all) scope=(--all) ;;
    *) echo "usage: $0 [--all] [--fix]" >&2; exit 2 ;;
  esac
done
command -v clang-format >/dev/null || {
  echo "error: clang-format is missing; run scripts/install-dependencies.sh --checks" >&2
  exit 2
}

mapfile -t files < <(scripts/changed-files.sh "${scope[@]}")
if [[ ${#files[@]} -eq 0 ]]; then
  echo "format: no file changed"
  exit 0
fi
if ! clang-format "${mode[@]}" "${files[@]}"; then
  echo "format: run scripts/check-format.sh --fix" >&2
  exit 1
fi
echo "format: ${#files[@]} files are fine"
