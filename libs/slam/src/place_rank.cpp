// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/place_rank.hpp"

#include "keyframe_files.hpp"
#include "loopmark/places/place_index.hpp"

namespace loopmark {

std::optional<PlaceRank> place_rank(const RunFolder& run, const std::vector<Keyframe>& keyframes, std::size_t source,
                                    std::size_t target, double loop_gap_m) {
  const auto apart = [&](std::size_t earlier) {
    return keyframes[earlier].piece != keyframes[source].piece ||
           comes_back(keyframes[earlier], keyframes[source], loop_gap_m);
  };
  if (!apart(target)) {
    return std::nullopt;
  }
  PlaceIndex index;
  for (std::size_t k = 0; k < source; ++k) {
    index.add(k, read_keyframe_place(run, k));
  }
  const std::vector<PlaceMatch> matches = index.query_exactly(read_keyframe_place(run, source), source, apart);
  PlaceRank result;
  result.places = matches.size();
  result.best_distance = matches.front().distance;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].id == target) {
      result.rank = i + 1;
      result.distance = matches[i].distance;
    }
  }
  return result;
}

}  // namespace loopmark
