// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/sweep.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "loopmark/core/files.hpp"
#include "text.hpp"

namespace loopmark {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

bool contains(const std::string& text, std::string_view words) { return text.find(words) != std::string::npos; }

/// The number in front of "s a sweep".
std::optional<double> period_in(const std::string& text) {
  const std::size_t end = text.find("s a sweep");
  if (end == std::string::npos) {
    return std::nullopt;
  }
  const auto words = io::split_words(std::string_view(text).substr(0, end), ',');
  const auto value = words.empty() ? std::nullopt : io::parse_number(words.back());
  return value && *value > 0.0 ? value : std::nullopt;
}

}  // namespace

std::vector<float> rebuild_time_offsets(const PointCloud& cloud, const SweepModel& model) {
  std::vector<float> offsets;
  offsets.reserve(cloud.size());
  const double direction = model.clockwise ? -1.0 : 1.0;
  for (const Eigen::Vector3f& point : cloud.points) {
    const double azimuth = std::atan2(static_cast<double>(point.y()), static_cast<double>(point.x()));
    double phase = direction * (azimuth - model.seam_azimuth_rad) / kTurn;
    phase -= std::floor(phase);
    offsets.push_back(static_cast<float>((phase - model.stamp_phase) * model.period_s));
  }
  return offsets;
}

SweepHint parse_sweep_hint(const std::string& raw) {
  const std::string text = io::lower_case(raw);
  SweepHint hint;
  if (contains(text, "motion compensated") || contains(text, "motion-compensated")) {
    hint.motion_compensated = !contains(text, "not motion");
  }
  const bool counter = contains(text, "counter-clockwise") || contains(text, "counterclockwise") ||
                       contains(text, "anticlockwise");
  if (!counter && !contains(text, "clockwise")) {
    return hint;
  }
  SweepModel model;
  model.clockwise = !counter;
  model.period_s = period_in(text).value_or(model.period_s);
  constexpr double kPi = std::numbers::pi;
  for (const auto& [words, azimuth] : {std::pair{"seam at the rear", kPi}, std::pair{"seam at the front", 0.0},
                                       std::pair{"seam at the left", kPi / 2}, std::pair{"seam at the right", -kPi / 2}}) {
    if (contains(text, words)) {
      model.seam_azimuth_rad = azimuth;
    }
  }
  hint.model = model;
  return hint;
}

SweepHint read_sweep_hint(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) ? parse_sweep_hint(read_file(path)) : SweepHint{};
}

}  // namespace loopmark
