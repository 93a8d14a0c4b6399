// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/set_check.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/cloud/overlap.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark::evaluation {
namespace {

std::vector<pair_sets::RegistrationPair> with_perturbations(std::vector<pair_sets::RegistrationPair> pairs,
                                                            const std::vector<Pose>& perturbations) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = pair_sets::make_pair(pairs[i].key, pairs[i].T_target_source * perturbations[i].inverse(),
                                    pairs[i].overlap, pairs[i].overlap_symmetric);
  }
  return pairs;
}

}  // namespace

SetCheck check_overlaps(const std::vector<pair_sets::RegistrationPair>& pairs, const std::vector<Pose>& perturbations,
                        const ScanLoader& load, std::size_t samples) {
  samples = std::min(samples, pairs.size());
  std::vector<double> stored(samples);
  std::vector<double> again(samples);
  std::vector<double> difference(samples);
  parallel_for(samples, [&](std::size_t i) {
    const std::size_t index = i * pairs.size() / samples;
    const pair_sets::RegistrationPair& pair = pairs[index];
    PointCloud source = load(pair.key.session, pair.key.source);
    if (index < perturbations.size()) {
      source = transformed(source, perturbations[index]);
    }
    stored[i] = pair.overlap_symmetric;
    again[i] = cloud::overlap(source, load(pair.key.target_session, pair.key.target), pair.T_target_source).symmetric;
    difference[i] = std::abs(again[i] - stored[i]);
  });
  return {samples, statistics::quantile(stored, 0.5), statistics::quantile(again, 0.5),
          statistics::quantile(difference, 0.5)};
}

bool match_set_to_scans(ExperimentTask& task, const ScanLoader& load) {
  const SetCheck check = check_overlaps(task.set.pairs, task.perturbations, load);
  if (check.agrees()) {
    return false;
  }
  if (!task.perturbations.empty()) {
    auto moved = with_perturbations(task.set.pairs, task.perturbations);
    if (check_overlaps(moved, task.perturbations, load).agrees()) {
      task.set.pairs = std::move(moved);
      return true;
    }
  }
  const std::string text = format_text(
      "the scans do not fit the set: symmetric overlap of %zu pairs is %.2f in the set, %.2f recomputed (medians)",
      check.samples, check.median_stored, check.median_recomputed);
  throw InputError(task.set_name, "", text,
                   "is this the data set that the pairs were chosen from? --no-check goes on anyway");
}

}  // namespace loopmark::evaluation
