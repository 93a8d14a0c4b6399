// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/matching/filters.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark::matching {
namespace {

template <class Predicate>
Correspondences keep_if(const Correspondences& matches, const Predicate& predicate) {
  Correspondences kept;
  std::copy_if(matches.begin(), matches.end(), std::back_inserter(kept), predicate);
  return kept;
}

}  // namespace

Correspondences correspondences_of(const TwoWayNearest& nearest) {
  Correspondences matches;
  matches.reserve(nearest.forward.size());
  for (std::size_t i = 0; i < nearest.forward.size(); ++i) {
    const NearestTwo& found = nearest.forward[i];
    if (found.first == kNoNeighbour) {
      continue;
    }
    Correspondence match;
    match.source = static_cast<std::uint32_t>(i);
    match.target = found.first;
    match.distance = std::sqrt(found.first_squared);
    const bool has_second = found.second != kNoNeighbour && found.second_squared > 0.0F;
    match.ratio = has_second ? std::sqrt(found.first_squared / found.second_squared) : 1.0F;
    match.mutual = nearest.backward[found.first].first == match.source;
    matches.push_back(match);
  }
  return matches;
}

Correspondences keep_mutual(const Correspondences& matches) {
  return keep_if(matches, [](const Correspondence& m) { return m.mutual; });
}

Correspondences keep_ratio(const Correspondences& matches, double max_ratio) {
  return keep_if(matches, [&](const Correspondence& m) { return static_cast<double>(m.ratio) <= max_ratio; });
}

Correspondences keep_best(Correspondences matches, std::size_t count) {
  std::sort(matches.begin(), matches.end(), better);
  if (count > 0 && matches.size() > count) {
    matches.resize(count);
  }
  return matches;
}

}  // namespace loopmark::matching
