// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_hypothesis.hpp"

#include <algorithm>
#include <utility>

namespace loopmark::localization::internal {

std::vector<SubmapHypothesis> distinct_hypotheses(std::vector<SubmapHypothesis> found,
                                                  const RelocalizationOptions& options) {
  std::stable_sort(found.begin(), found.end(), [](const SubmapHypothesis& a, const SubmapHypothesis& b) {
    return a.place_evidence.registration > b.place_evidence.registration;
  });
  std::vector<SubmapHypothesis> distinct;
  for (SubmapHypothesis& one : found) {
    const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const SubmapHypothesis& other) {
      return agree(one.answer.T_map_lidar, other.answer.T_map_lidar, options);
    });
    if (same == distinct.end()) {
      distinct.push_back(std::move(one));
      continue;
    }
    same->centers.insert(one.centers.begin(), one.centers.end());
  }
  for (SubmapHypothesis& one : distinct) {
    one.place_evidence.support = static_cast<double>(one.centers.size());
  }
  return distinct;
}

}  // namespace loopmark::localization::internal
