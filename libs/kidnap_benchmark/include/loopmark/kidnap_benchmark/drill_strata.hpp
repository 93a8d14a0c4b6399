// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What kind of place a keyframe stands at, measured from the map itself.
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/mapping/solved_map.hpp"

namespace loopmark::kidnap_benchmark {

enum class Stratum { kStraight, kJunction, kOpen, kNearIdentical };
inline constexpr Stratum kStrata[] = {Stratum::kStraight, Stratum::kJunction, Stratum::kOpen, Stratum::kNearIdentical};
const char* name(Stratum stratum);

/// What the strata are told by.
struct PlaceCharacter {
  double turn_deg = 0.0;     ///< by which the path turns within 12 m before and behind
  bool crossing = false;     ///< another stretch passes within 12 m, 45 to 135 degrees across
  double structure = 0.0;    ///< square metres within 40 m where something stands 1 m high or more
  double same_place = 0.0;   ///< distance of the place descriptor to the most alike one 3 to 10 m away; 0: none
  double other_place = 2.0;  ///< the same of the most alike place at least 30 m away; 2: none
  Stratum stratum = Stratum::kStraight;
};

/// Near-identical: another place looks more alike than the same place a few metres on. Open: less than 40 % of the
/// median structure of the map. Junction: the path turns by over 30 degrees or is crossed. Straight: all else.
Stratum stratum_of(const PlaceCharacter& place, double median_structure);

/// One for every keyframe. Throws InputError when a file of the run is missing or damaged.
std::vector<PlaceCharacter> characterise_places(const map_store::RunFolder& run, const mapping::SolvedMap& map);

}  // namespace loopmark::kidnap_benchmark
