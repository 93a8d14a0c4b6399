// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a person should know of a map before looking at it, in sentences.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/map_store/loop_decisions.hpp"
#include "loopmark/mapping/solved_map.hpp"

namespace loopmark::map_page {

/// A solved run. References must outlive it.
struct MapRecords {
  const std::vector<map_store::ScanRecord>& scans;
  const std::vector<map_store::LoopRecord>& loops;
  const mapping::SolvedMap& map;
  const std::vector<map_store::LoopDecision>& decisions;
  const std::vector<Pose>& truth;  ///< one pose a scan, or none
  double min_loop_p = 0.9;
};

enum class Severity {
  kProblem,  ///< the map is wrong or lacks something
  kLook,     ///< a person should look
  kGood
};

enum class LinkKind {
  kScans,  ///< from `first` to `last`
  kLoop,   ///< number of the loop record
  kAnswer  ///< place in the layer of answers
};

/// Where a finding leads.
struct FindingLink {
  std::string text;
  LinkKind kind = LinkKind::kScans;
  std::size_t first = 0;
  std::size_t last = 0;
};

struct Finding {
  Severity severity = Severity::kLook;
  std::string text;
  std::vector<FindingLink> links;  ///< the most important first
};

/// The gravest first.
std::vector<Finding> findings(const MapRecords& records);

/// Standard deviations (metres) of the position of a scan along the axes of the map, from the covariance of xi in
/// exp(xi) * T: a small xi = [rho; phi] moves the position p by rho + phi x p.
Eigen::Vector3d position_sigma(const Pose& T_map_scan, const Matrix6d& covariance);

}  // namespace loopmark::map_page
