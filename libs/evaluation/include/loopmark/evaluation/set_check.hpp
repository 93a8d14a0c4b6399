// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Does a set belong to the scans that are given?
#pragma once

#include "loopmark/evaluation/experiment.hpp"

namespace loopmark::evaluation {

/// Overlaps of a few pairs as the set has them and as the scans give them.
struct SetCheck {
  std::size_t samples = 0;
  double median_stored = 0.0;      ///< symmetric overlap in the set
  double median_recomputed = 0.0;  ///< of the scans at the set's motions
  double median_difference = 0.0;  ///< of the absolute differences
  bool agrees() const { return samples == 0 || median_difference < 0.15; }
};

/// Recomputes the symmetric overlap of `samples` pairs, spread over the set.
SetCheck check_overlaps(const std::vector<pair_sets::RegistrationPair>& pairs, const std::vector<Pose>& perturbations,
                        const ScanLoader& load, std::size_t samples = 5);

/// Makes sure that the task's scans are those that its set was made of; throws InputError when they are not. Where
/// there are perturbations and the set's motions are of the scans before them, the motions are changed to include
/// them; returns whether that was so.
bool match_set_to_scans(ExperimentTask& task, const ScanLoader& load);

}  // namespace loopmark::evaluation
