// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluate_run.hpp"
#include "loopmark/evaluation/algorithm.hpp"

namespace loopmark::app {

/// What competes, in the order of the tables: motions files, the algorithms by name, foreign programs, and each of
/// them once more for every refinement. Throws InputError naming what does not exist.
evaluation::AlgorithmList make_algorithms(const EvaluateArguments& arguments, const workflows::ProgramOptions& options,
                                          const evaluation::EvaluatedSet& set);

}  // namespace loopmark::app
