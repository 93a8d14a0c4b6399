// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/map_verdict.hpp"

#include <algorithm>
#include <cstdio>

namespace loopmark::mapping {
namespace {

constexpr double kSure = 0.99;             ///< P(correct) of a registration that is not wrong by chance
constexpr double kRight_m = 0.6;           ///< what counts as right of a registration, everywhere in this program,
constexpr double kRight_deg = 5.0;         ///< and this;
constexpr double kRightOfDistance = 0.02;  ///< of scans far apart, this share of their distance
constexpr double kManyDamaged = 0.1;       ///< share of the scans

/// The scans for which `is` holds.
template <class Is>
std::vector<std::size_t> scans_that(const std::vector<map_store::ScanRecord>& scans, const Is& is) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (is(i)) {
      found.push_back(i);
    }
  }
  return found;
}

void add(std::vector<MapDoubt>& doubts, const std::string& reason, std::vector<std::size_t> scans) {
  if (!scans.empty()) {
    doubts.push_back({std::to_string(scans.size()) + reason, std::move(scans)});
  }
}

/// By how much a registration and the map differ about two keyframes of one component.
PoseError contradiction(const map_store::LoopRecord& loop, const SolvedMap& map) {
  const Pose T_target_source = map.T_map_keyframe[loop.target].inverse() * map.T_map_keyframe[loop.source];
  return pose_error(T_target_source, loop.T_target_source);
}

/// Registrations that are sure and that the map does not keep, though it knows both places.
void add_contradictions(const std::vector<map_store::LoopRecord>& loops, const SolvedMap& map,
                        std::vector<MapDoubt>& doubts) {
  std::vector<std::size_t> scans;
  std::string worst;
  double most_m = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const map_store::LoopRecord& loop = loops[i];
    const bool one_frame = map.solution.component_of[loop.source] == map.solution.component_of[loop.target];
    if (!loop.answered || loop.p_correct < kSure || map.loops[i].accepted || !one_frame ||
        map.loops[i].reason == to_string(map_store::LoopOverride::kVeto)) {
      continue;
    }
    const PoseError error = contradiction(loop, map);
    const double apart_m = loop.T_target_source.translation().norm();
    if (error.translation_m < std::max(kRight_m, kRightOfDistance * apart_m) && error.rotation_deg < kRight_deg) {
      continue;
    }
    ++count;
    scans.push_back(map.keyframes[loop.target].scan);
    scans.push_back(map.keyframes[loop.source].scan);
    if (error.translation_m > most_m) {
      most_m = error.translation_m;
      char text[160];
      std::snprintf(text, sizeof text, ", the worst: scans %zu and %zu by %.1f m (P(correct) %.3f)",
                    map.keyframes[loop.source].scan, map.keyframes[loop.target].scan, most_m, loop.p_correct);
      worst = text;
    }
  }
  std::sort(scans.begin(), scans.end());
  scans.erase(std::unique(scans.begin(), scans.end()), scans.end());
  if (count > 0) {
    doubts.push_back({std::to_string(count) + " registrations that are sure contradict the map" + worst, scans});
  }
}

}  // namespace

std::vector<MapDoubt> doubts_of(const std::vector<map_store::ScanRecord>& scans,
                                const std::vector<map_store::LoopRecord>& loops, const SolvedMap& map) {
  std::vector<MapDoubt> doubts;
  add(doubts, " scans have no place in the map: nothing joins their parts to it",
      scans_that(scans, [&](std::size_t i) { return map.component[i] != 0; }));
  add(doubts, " scans may have slid: few points fit or a direction is not held, and registration does not confirm them",
      scans_that(scans, [&](std::size_t i) {
        return scans[i].state == map_store::ScanState::kTracked && !scans[i].problem.empty();
      }));
  add_contradictions(loops, map, doubts);
  std::vector<std::size_t> damaged =
      scans_that(scans, [&](std::size_t i) { return scans[i].state == map_store::ScanState::kDamaged; });
  if (static_cast<double>(damaged.size()) > kManyDamaged * static_cast<double>(scans.size())) {
    add(doubts, " scans could not be used", std::move(damaged));
  }
  add(doubts, " times do not rise", scans_that(scans, [&](std::size_t i) {
        return i > 0 && scans[i].segment == scans[i - 1].segment && scans[i].stamp_s <= scans[i - 1].stamp_s;
      }));
  return doubts;
}

std::string verdict_text(const std::vector<MapDoubt>& doubts) {
  constexpr std::size_t kShown = 5;
  std::string text = doubts.empty() ? "good" : "doubtful: ";
  for (std::size_t k = 0; k < doubts.size(); ++k) {
    const std::vector<std::size_t>& scans = doubts[k].scans;
    text += (k > 0 ? "; " : "") + doubts[k].reason;
    for (std::size_t i = 0; i < std::min(kShown, scans.size()); ++i) {
      text += (i > 0 ? ", " : " (scans ") + std::to_string(scans[i]);
    }
    text += scans.size() > kShown ? ", ...)" : scans.empty() ? "" : ")";
  }
  return text;
}

}  // namespace loopmark::mapping
