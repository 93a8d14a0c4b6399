// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/core/options.hpp"

namespace loopmark::localization {

/// How a place is searched in a map, and when it counts as found or lost.
struct RelocalizationOptions {
  std::size_t places = 8;          ///< places of the map that a searching scan is registered to, at most
  std::size_t aliased_places = 3;  ///< further places, that look like the one where a scan was found
  double place_radius_m = 12.0;    ///< keyframes nearer than this are one place, and form its submap
  double places_apart_m = 30.0;    ///< of the places that are asked: registration reaches further than a submap
  double search_every_m = 1.0;     ///< while searching, a scan is registered after this distance
  double min_p_correct = 0.5;      ///< answers below this probability are not given
  double min_lead = 4.0;           ///< nor while the next place is more than one so many-th as probable
  double tracking_p = 0.9;         ///< above it tracking in the map begins
  double same_place_m = 1.5;       ///< answers nearer than this,
  double same_place_deg = 8.0;     ///< and turned by less, say the same
  double repeat_weight = 0.5;      ///< weight of another scan's evidence for the same place: scans err alike
  double miss_odds = 0.4;          ///< factor on the odds of a place that another scan does not confirm
  double map_radius_m = 60.0;      ///< part of the map that tracking aligns to
  double min_inlier_share = 0.35;  ///< of a scan's keypoints that must fit the map
  std::size_t lost_after = 3;      ///< scans in a row that do not fit: the place is lost
  double max_jump_m = 1.5;         ///< disagreement of map and odometry in one scan, beyond it a scan does not fit
  double verify_every_m = 5.0;     ///< while tracking, registration judges the pose after this distance
  double compare_every_m = 50.0;   ///< and the whole map is asked about the scan after this one,
  double doubt_share = 0.8;        ///< and when fewer than this share of the usual keypoints fit the map
  double max_gap_s = 2.0;          ///< without a scan for longer, the place is lost
};

template <class Visitor>
void describe(Visitor& v, RelocalizationOptions& o) {
  v.field("places", o.places, "places of the map that a searching scan is registered to, at most");
  v.field("twins", o.aliased_places, "further places, that look like the one where a scan was found");
  v.field("place_radius_m", o.place_radius_m, "keyframes nearer than this are one place, and form its submap, metres");
  v.field("places_apart_m", o.places_apart_m, "least distance of the places that are asked from each other, metres");
  v.field("search_every_m", o.search_every_m, "while searching, a scan is registered after this distance, metres");
  v.field("min_p_correct", o.min_p_correct, "answers below this probability are not given");
  v.field("min_lead", o.min_lead, "nor while the next place is more than one so many-th as probable");
  v.field("tracking_p", o.tracking_p, "above it tracking in the map begins");
  v.field("same_place_m", o.same_place_m, "answers nearer than this, metres,");
  v.field("same_place_deg", o.same_place_deg, "and turned by less, degrees, say the same");
  v.field("repeat_weight", o.repeat_weight, "weight of another scan's evidence for the same place");
  v.field("miss_odds", o.miss_odds, "factor on the odds of a place that another scan does not confirm");
  v.field("map_radius_m", o.map_radius_m, "part of the map that tracking aligns to, metres");
  v.field("min_inlier_share", o.min_inlier_share, "of a scan's keypoints that must fit the map");
  v.field("lost_after", o.lost_after, "scans in a row that do not fit: the place is lost");
  v.field("max_jump_m", o.max_jump_m, "disagreement of map and odometry in one scan, metres");
  v.field("verify_every_m", o.verify_every_m,
          "while tracking, registration judges the pose after this distance, metres");
  v.field("compare_every_m", o.compare_every_m, "and the whole map is asked after this distance, metres");
  v.field("doubt_share", o.doubt_share, "and when fewer than this share of the usual keypoints fit the map");
  v.field("max_gap_s", o.max_gap_s, "without a scan for longer, the place is lost, seconds");
}

/// Throws InputError naming the option whose value makes no sense.
void check(const RelocalizationOptions& options);

}  // namespace loopmark::localization
