// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "found_place.hpp"

#include <algorithm>
#include <utility>

namespace loopmark {

std::vector<FoundPlace> distinct_places_found(std::vector<FoundPlace> found, const RelocalizationOptions& options) {
  std::stable_sort(found.begin(), found.end(), [](const FoundPlace& a, const FoundPlace& b) {
    return a.voices.registration > b.voices.registration;
  });
  std::vector<FoundPlace> distinct;
  for (FoundPlace& one : found) {
    const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const FoundPlace& other) {
      return say_the_same(one.answer.T_map_lidar, other.answer.T_map_lidar, options);
    });
    if (same == distinct.end()) {
      distinct.push_back(std::move(one));
      continue;
    }
    same->centers.insert(one.centers.begin(), one.centers.end());
  }
  for (FoundPlace& one : distinct) {
    one.voices.support = static_cast<double>(one.centers.size());
  }
  return distinct;
}

}  // namespace loopmark
