// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/workflows/merge_run.hpp"

namespace loopmark::app {

/// Prints what became of the drives and the map; warnings to standard error.
void print_merge(const workflows::MergeOutcome& outcome);

}  // namespace loopmark::app
