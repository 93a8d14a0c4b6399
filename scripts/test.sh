#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Configures, builds and tests everything in build/release; the output ends with ctest's summary.
#   scripts/test.sh [CTEST ARGUMENTS]     e.g. scripts/test.sh -R pose
# LOOPMARK_BUILD_DIR: another build folder. LOOPMARK_JOBS: how many jobs at a time.
set -euo pipefail
# shellcheck source=scripts/lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

configure -DLOOPMARK_BUILD_TESTS=ON
build_target all
exec ctest --test-dir "$build_dir" --output-on-failure --parallel "$jobs" "$@"
