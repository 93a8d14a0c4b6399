// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/place_rank.hpp"

#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/places/place_index.hpp"

namespace loopmark::localization {

std::optional<PlaceRank> place_rank(const map_store::RunFolder& run, const std::vector<mapping::Keyframe>& keyframes,
                                    std::size_t source, std::size_t target, double loop_gap_m) {
  const auto apart = [&](std::size_t earlier) {
    return keyframes[earlier].segment != keyframes[source].segment ||
           mapping::is_revisit(keyframes[earlier], keyframes[source], loop_gap_m);
  };
  if (!apart(target)) {
    return std::nullopt;
  }
  places::PlaceIndex index;
  for (std::size_t k = 0; k < source; ++k) {
    index.add(k, map_store::read_keyframe_place(run, k));
  }
  const std::vector<places::PlaceMatch> matches =
      index.query_exactly(map_store::read_keyframe_place(run, source), source, apart);
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

}  // namespace loopmark::localization
