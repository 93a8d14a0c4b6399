// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/map_components.hpp"

#include <set>

namespace loopmark::mapping {
namespace {

/// The scans of each component: how many, from where to where, and how far they were driven.
void count_scans(const std::vector<map_store::ScanRecord>& scans, const SolvedMap& map,
                 std::vector<MapComponent>& components) {
  std::vector<std::set<std::size_t>> segments(components.size());
  std::vector<const map_store::ScanRecord*> last(components.size(), nullptr);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    MapComponent& component = components[map.component[i]];
    if (component.scans++ == 0) {
      component.first_scan = i;
      component.begin_s = scans[i].stamp_s;
    }
    component.last_scan = i;
    component.end_s = scans[i].stamp_s;
    component.keyframes += scans[i].keyframe ? 1 : 0;
    if (scans[i].state == map_store::ScanState::kDamaged) {
      continue;
    }
    segments[map.component[i]].insert(scans[i].segment);
    const map_store::ScanRecord*& before = last[map.component[i]];
    if (before != nullptr && before->segment == scans[i].segment) {
      component.path_m += (before->T_segment_lidar.inverse() * scans[i].T_segment_lidar).translation().norm();
    }
    before = &scans[i];
  }
  for (std::size_t c = 0; c < components.size(); ++c) {
    components[c].segments = segments[c].size();
  }
}

void note_candidate(const SolvedMap& map, const map_store::LoopRecord& loop, const LoopVerdict& verdict,
                    MapComponent& component) {
  ++component.candidates;
  if (component.best.empty() || loop.p_correct > component.best_p) {
    component.best_p = loop.p_correct;
    component.best = std::to_string(map.keyframes[loop.source].scan) + "-" +
                     std::to_string(map.keyframes[loop.target].scan) +
                     (verdict.reason.empty() ? "" : ": " + verdict.reason);
  }
}

}  // namespace

std::string component_name(std::size_t component) {
  return component == 0 ? "main" : "component_" + std::to_string(component);
}

std::vector<MapComponent> map_components(const std::vector<map_store::ScanRecord>& scans,
                                         const std::vector<map_store::LoopRecord>& loops, const SolvedMap& map) {
  std::vector<MapComponent> components(map.components);
  for (std::size_t c = 0; c < components.size(); ++c) {
    components[c].name = component_name(c);
    components[c].anchored = map.solution.components[c].anchored;
  }
  count_scans(scans, map, components);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::size_t a = map.solution.component_of[loops[i].source];
    const std::size_t b = map.solution.component_of[loops[i].target];
    if (a != b) {
      note_candidate(map, loops[i], map.loops[i], components[a]);
      note_candidate(map, loops[i], map.loops[i], components[b]);
    }
  }
  return components;
}

}  // namespace loopmark::mapping
