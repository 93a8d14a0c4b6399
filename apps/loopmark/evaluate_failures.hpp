// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loopmark/evaluation/experiment.hpp"
#include "loopmark/report/page.hpp"

namespace loopmark::app {

/// The failed pairs of a result: a list for each algorithm, then for each pair that any of them failed one picture of
/// what was answered (up to three answers that differ) and what is true. `pictures`: no more than this many, the first
/// of the set; none without `load`.
void add_failures(report::Page& page, const evaluation::StoredResult& result, const evaluation::ScanLoader& load,
                  const std::vector<Pose>& perturbations, std::size_t pictures);

}  // namespace loopmark::app
