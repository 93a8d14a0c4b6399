// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/relocalization_options.hpp"

#include "loopmark/localization/relocalizer.hpp"

namespace loopmark::localization {

const char* name(RelocalizationState state) {
  switch (state) {
    case RelocalizationState::kSearching:
      return "searching";
    case RelocalizationState::kTracking:
      return "tracking";
    case RelocalizationState::kLost:
      break;
  }
  return "lost";
}

void check(const RelocalizationOptions& o) {
  require_option(o.places >= 1, "places", "must be at least 1");
  require_option(o.place_radius_m > 0.0, "place_radius_m", "must be positive");
  require_option(o.places_apart_m > 0.0, "places_apart_m", "must be positive");
  require_option(o.min_p_correct > 0.0 && o.min_p_correct < 1.0, "min_p_correct", "must be above 0, below 1");
  require_option(o.min_lead >= 1.0, "min_lead", "must be at least 1");
  require_option(o.tracking_p >= o.min_p_correct && o.tracking_p < 1.0, "tracking_p", "must be min_p_correct to 1");
  require_option(o.same_place_m > 0.0 && o.same_place_deg > 0.0, "same_place_m", "must be positive");
  require_option(o.miss_odds > 0.0 && o.miss_odds <= 1.0, "miss_odds", "must be above 0, at most 1");
  require_option(o.map_radius_m > 0.0, "map_radius_m", "must be positive");
  require_option(o.lost_after >= 1, "lost_after", "must be at least 1");
  require_option(o.verify_every_m > 0.0, "verify_every_m", "must be positive");
  require_option(o.compare_every_m > 0.0, "compare_every_m", "must be positive");
  require_option(o.max_gap_s > 0.0, "max_gap_s", "must be positive");
}

}  // namespace loopmark::localization
