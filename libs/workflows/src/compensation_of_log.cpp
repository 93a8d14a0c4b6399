// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/compensation_of_log.hpp"

#include <cstdio>

namespace loopmark::workflows {
namespace {

constexpr std::size_t kWindow = 12;
constexpr std::size_t kLeast = 8;
constexpr double kLongestSpacing_s = 0.3;  ///< of scans that follow each other; keyframes are farther apart

bool usable(const io::DriveLog& log, std::size_t index) {
  try {
    return !log.read(index).cloud.empty();
  } catch (const InputError&) {
    return false;
  }
}

/// The scans from `begin` on, as long as they follow each other closely and can be read.
std::vector<std::size_t> stretch_from(const io::DriveLog& log, std::size_t begin) {
  std::vector<std::size_t> window;
  for (std::size_t i = begin; i < log.size() && window.size() < kWindow; ++i) {
    const double spacing = i == begin ? kLongestSpacing_s : log.stamp_s(i) - log.stamp_s(i - 1);
    if (spacing <= 0.0 || spacing > kLongestSpacing_s || !usable(log, i)) {
      break;
    }
    window.push_back(i);
  }
  return window;
}

/// Stretches spread over the log.
std::vector<std::vector<std::size_t>> stretches(const io::DriveLog& log) {
  std::vector<std::vector<std::size_t>> windows;
  for (const double share : {0.2, 0.5, 0.8}) {
    const auto begin = static_cast<std::size_t>(share * static_cast<double>(log.size()));
    std::vector<std::size_t> window = stretch_from(log, begin);
    if (window.size() >= kLeast && (windows.empty() || windows.back().back() < begin)) {
      windows.push_back(std::move(window));
    }
  }
  return windows;
}

}  // namespace

odometry::CompensationMeasurement compensation_of_log(const io::DriveLog& log) {
  const auto windows = stretches(log);
  const bool times_given = !windows.empty() && log.read_closely(windows.front().front()).times_in_file;
  return odometry::measure_compensation(
      windows, [&](std::size_t i) { return log.read(i); }, times_given, {},
      log.info().sweep.value_or(cloud::SweepModel{}));
}

std::string describe_measurement(const odometry::CompensationMeasurement& m) {
  if (m.verdict == odometry::Compensation::kUnknown) {
    return "cannot be measured: " + m.reason;
  }
  std::string text = m.verdict == odometry::Compensation::kCompensated
                         ? "yes"
                         : std::string("no, ") + odometry::compensation_name(m.verdict);
  char number[64];
  const char* separator = ": scans fit to ";
  for (const odometry::CompensationTrial& trial : m.trials) {
    std::snprintf(number, sizeof number, "%.1f mm if ", 1e3 * trial.residual_m);
    text += separator + std::string(number) + odometry::compensation_name(trial.assumption);
    separator = ", ";
  }
  std::snprintf(number, sizeof number, " (%.0f sigma, at %.1f m/s)", m.sigmas, m.speed_m_s);
  return text + number;
}

}  // namespace loopmark::workflows
