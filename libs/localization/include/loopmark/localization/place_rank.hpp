// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/mapping/solved_map.hpp"

namespace loopmark::localization {

/// How alike two keyframes' places look, among all that one could have been taken for.
struct PlaceRank {
  std::size_t rank = 1;        ///< 1: the most alike
  std::size_t places = 0;      ///< earlier keyframes that are no part of the drive just before
  double distance = 0.0;       ///< of the descriptors
  double best_distance = 0.0;  ///< of the most alike place
};

/// The rank of `target` among the places that the later keyframe `source` could be. Nothing when the target was passed
/// within `loop_gap_m` of driving in the same segment, so that it is no loop. Throws InputError when a descriptor is
/// missing or damaged.
std::optional<PlaceRank> place_rank(const map_store::RunFolder& run, const std::vector<mapping::Keyframe>& keyframes,
                                    std::size_t source, std::size_t target, double loop_gap_m);

}  // namespace loopmark::localization
