// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/compensation_of_log.hpp"

#include <cstdio>

#include "loopmark/core/number_text.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/odometry/world_frame.hpp"

namespace loopmark::workflows {
namespace {

constexpr std::size_t kWindow = 12;
constexpr std::size_t kLeast = 8;
constexpr double kLongestOfKeyframes_s = 5.0;
constexpr double kLongestSpacing_s = 0.3;  ///< of scans that follow each other; keyframes are farther apart

/// The points of a scan, none where it cannot be read.
std::vector<Eigen::Vector3f> points_of(const io::DriveLog& log, std::size_t index) {
  try {
    return log.read(index).cloud.points;
  } catch (const InputError&) {
    return {};
  }
}

/// The scans from `begin` on, as long as they follow each other closely and can be read; copies of the one before are
/// left out.
std::vector<std::size_t> stretch_from(const io::DriveLog& log, std::size_t begin, double longest_s) {
  std::vector<std::size_t> window;
  std::vector<Eigen::Vector3f> last;
  for (std::size_t i = begin; i < log.size() && window.size() < kWindow; ++i) {
    const double spacing = window.empty() ? longest_s : log.stamp_s(i) - log.stamp_s(window.back());
    std::vector<Eigen::Vector3f> points = points_of(log, i);
    if (spacing <= 0.0 || spacing > longest_s || points.empty()) {
      break;
    }
    if (points != last) {
      window.push_back(i);
      last = std::move(points);
    }
  }
  return window;
}

/// Stretches spread over the log.
std::vector<std::vector<std::size_t>> stretches(const io::DriveLog& log) {
  std::vector<std::vector<std::size_t>> windows;
  for (const double share : {0.2, 0.5, 0.8}) {
    const auto begin = static_cast<std::size_t>(share * static_cast<double>(log.size()));
    std::vector<std::size_t> window = stretch_from(log, begin, kLongestSpacing_s);
    if (window.size() >= kLeast && (windows.empty() || windows.back().back() < begin)) {
      windows.push_back(std::move(window));
    }
  }
  return windows;
}

}  // namespace

odometry::CompensationMeasurement compensation_of_log(const io::DriveLog& log) {
  const Progress progress("measuring motion compensation");
  const auto windows = stretches(log);
  const bool times_given = !windows.empty() && log.read_closely(windows.front().front()).times_in_file;
  return odometry::measure_compensation(
      windows, [&](std::size_t i) { return log.read(i); }, times_given, {},
      log.info().sweep.value_or(cloud::SweepModel{}));
}

std::string frame_problem_of_log(const io::DriveLog& log) {
  for (const std::size_t begin : {std::size_t{0}, log.size() / 2}) {
    const std::vector<std::size_t> window = stretch_from(log, begin, kLongestOfKeyframes_s);
    const odometry::FrameFinding found = odometry::find_world_frame(window, [&](std::size_t i) { return log.read(i); });
    if (found.in_world_frame) {
      char text[256];
      std::snprintf(
          text, sizeof text,
          "scans %zu to %zu fit each other without motion (%.2f m), while the blind spot around the sensor moves "
          "by %.1f m: they seem to stand in one world frame already",
          window.front(), window.back(), found.motion_m, found.blind_spot_m);
      return text;
    }
  }
  return "";
}

std::string describe_measurement(const odometry::CompensationMeasurement& m) {
  if (m.verdict == odometry::Compensation::kUnknown) {
    return "cannot be measured: " + m.reason;
  }
  std::string text = m.verdict == odometry::Compensation::kCompensated
                         ? "yes"
                         : std::string("no, ") + odometry::compensation_name(m.verdict);
  const char* separator = ": scans fit to ";
  for (const odometry::CompensationTrial& trial : m.trials) {
    text +=
        separator + format_text("%.1f mm if ", 1e3 * trial.residual_m) + odometry::compensation_name(trial.assumption);
    separator = ", ";
  }
  return text + format_text(" (%.0f sigma, at %.1f m/s)", m.sigmas, m.speed_m_s);
}

}  // namespace loopmark::workflows
