// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What relocalization of a log gave, as files and numbers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/localization/relocalizer.hpp"
#include "loopmark/mapping/map_truth.hpp"

namespace loopmark::localization {

struct RelocalizationSummary {
  std::size_t scans = 0;
  std::size_t answered = 0;
  double first_answer_s = -1.0;  ///< from the first scan to the first answer; -1: there was none
  std::size_t losses = 0;        ///< times a place that was known was lost
  std::size_t recoveries = 0;    ///< times it was found again
  double seconds = 0.0;          ///< of computing

  // Where the truth is known:
  std::size_t judged = 0;  ///< answers that could be compared
  std::size_t wrong = 0;   ///< of those, further than 0.6 m or 5 deg from the truth
  double median_error_m = 0.0;
};

RelocalizationSummary summarize(const std::vector<RelocalizedScan>& scans);

/// Whether an answer is right: nearer than 0.6 m and turned by less than 5 degrees.
inline bool is_right(const PoseError& error) { return error.translation_m < 0.6 && error.rotation_deg < 5.0; }

/// Compares answers with the truth. `true_query` has one pose for each scan of the log, in the world of the map's
/// truth.
void judge(const std::vector<RelocalizedScan>& scans, const mapping::MapTruth& map, const std::vector<Pose>& true_query,
           RelocalizationSummary& summary);

/// relocalization.csv (a row a scan; cov_ij: the upper triangle of the covariance, x y z roll pitch yaw),
/// trajectory.tum (answers only), summary.json and timings.json in `folder`; only the last depends on the machine.
void write_relocalization(const std::filesystem::path& folder, const std::vector<RelocalizedScan>& scans,
                          const RelocalizationSummary& summary);

}  // namespace loopmark::localization
