// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Answers to "where is the sensor in this map", to be shown on it: of relocalization, or of a kidnap benchmark.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "loopmark/map_page/findings.hpp"

namespace loopmark::map_page {

struct Answer {
  std::string name;                                           ///< what was asked about: "scan 120", "event 7"
  double stamp_s = 0.0;                                       ///< of it
  std::size_t kind = 0;                                       ///< of AnswerLayer::kinds
  bool placed = false;                                        ///< there is a position
  Eigen::Vector3d position = Eigen::Vector3d::Zero();         ///< in the map, metres
  double sigma_m = std::numeric_limits<double>::quiet_NaN();  ///< of the position; not a number: unknown
  double p_correct = 0.0;
  Eigen::Vector3d truth = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());  ///< likewise
  double error_m = std::numeric_limits<double>::quiet_NaN();
  double error_deg = std::numeric_limits<double>::quiet_NaN();
  bool wrong = false;  ///< placed, and known to be elsewhere
  std::string words;   ///< why there is no position, or what else is to be said
};

struct AnswerLayer {
  std::string title;               ///< "Relocalization of drives/day2"
  std::vector<std::string> kinds;  ///< "searching", "tracking", "lost"
  std::vector<Answer> answers;     ///< in the order in which they were asked
};

/// What a person should know of the answers, the gravest first: wrong ones, long stretches without a position.
std::vector<Finding> findings(const AnswerLayer& layer);

}  // namespace loopmark::map_page
