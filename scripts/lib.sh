# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Shared by the scripts: where things are, how many jobs fit, configuring and building.
# shellcheck shell=bash

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=${LOOPMARK_BUILD_DIR:-$source_dir/build/release}

# One job a core, but no more than one for each 2 GB of memory: the largest compilations need that much.
job_count() {
  local cores memory_kb
  cores=$(nproc)
  memory_kb=$(awk '/^MemTotal/ { print $2 }' /proc/meminfo)
  local fitting=$((memory_kb / 2000000))
  echo $((fitting < 1 ? 1 : fitting < cores ? fitting : cores))
}

jobs=${LOOPMARK_JOBS:-$(job_count)}

# configure [CMAKE ARGUMENTS]: Release, with Ninja and ccache where they are installed.
configure() {
  local options=(-DCMAKE_BUILD_TYPE=Release)
  if [[ ! -f "$build_dir/CMakeCache.txt" ]]; then
    if command -v ninja >/dev/null; then options+=(-G Ninja); fi
  fi
  if command -v ccache >/dev/null; then
    options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  cmake -S "$source_dir" -B "$build_dir" "${options[@]}" "$@"
}

# build_target NAME: "all" for everything.
build_target() {
  cmake --build "$build_dir" --parallel "$jobs" --target "$1"
}
