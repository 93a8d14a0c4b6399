// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// When each point of a sweep was measured, rebuilt from its azimuth for logs that do not say.
#pragma once

#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"

namespace loopmark {

/// How a spinning LiDAR sweeps: it starts at the seam and turns once in `period_s`.
struct SweepModel {
  bool clockwise = true;                     ///< seen from above (from +z)
  double seam_azimuth_rad = std::numbers::pi;  ///< azimuth atan2(y, x) where a sweep starts and ends
  double period_s = 0.1;                     ///< of one turn
  double stamp_phase = 0.5;                  ///< where in the sweep the scan's stamp is: 0 start, 0.5 middle, 1 end
};

/// Time of each point relative to the scan's stamp: (phase - stamp_phase) * period_s with the phase
/// in [0, 1) of the angle turned since the seam. A clockwise sweep from the rear, stamped in its middle,
/// gives -atan2(y, x) / (2 pi) * period_s.
std::vector<float> rebuild_time_offsets(const PointCloud& cloud, const SweepModel& model);

/// What a sweep.txt beside the scans says, in plain words: "clockwise" or "counter-clockwise", "seam at the
/// rear" (front, left, right), "0.1 s a sweep", "not motion compensated".
struct SweepHint {
  std::optional<SweepModel> model;          ///< set when the direction is said
  std::optional<bool> motion_compensated;   ///< set when it is said
};
SweepHint parse_sweep_hint(const std::string& text);

/// The hint of the file; nothing when there is no such file.
SweepHint read_sweep_hint(const std::filesystem::path& path);

}  // namespace loopmark
