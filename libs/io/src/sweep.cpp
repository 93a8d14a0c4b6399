// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/sweep.hpp"

#include <numbers>
#include <string_view>
#include <utility>

#include "loopmark/storage/files.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io {
namespace {

bool contains(const std::string& text, std::string_view words) { return text.find(words) != std::string::npos; }

/// The number in front of "s a sweep".
std::optional<double> period_in(const std::string& text) {
  const std::size_t end = text.find("s a sweep");
  if (end == std::string::npos) {
    return std::nullopt;
  }
  const auto words = text::split_words(std::string_view(text).substr(0, end), ',');
  const auto value = words.empty() ? std::nullopt : text::parse_number(words.back());
  return value && *value > 0.0 ? value : std::nullopt;
}

}  // namespace

SweepHint parse_sweep_hint(const std::string& raw) {
  const std::string text = text::lower_case(raw);
  SweepHint hint;
  if (contains(text, "motion compensated") || contains(text, "motion-compensated")) {
    hint.motion_compensated = !contains(text, "not motion");
  }
  const bool counter =
      contains(text, "counter-clockwise") || contains(text, "counterclockwise") || contains(text, "anticlockwise");
  if (!counter && !contains(text, "clockwise")) {
    return hint;
  }
  cloud::SweepModel model;
  model.clockwise = !counter;
  model.period_s = period_in(text).value_or(model.period_s);
  constexpr double kPi = std::numbers::pi;
  for (const auto& [words, azimuth] :
       {std::pair{"seam at the rear", kPi}, std::pair{"seam at the front", 0.0}, std::pair{"seam at the left", kPi / 2},
        std::pair{"seam at the right", -kPi / 2}}) {
    if (contains(text, words)) {
      model.seam_azimuth_rad = azimuth;
    }
  }
  hint.model = model;
  return hint;
}

SweepHint read_sweep_hint(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) ? parse_sweep_hint(storage::read_file(path)) : SweepHint{};
}

}  // namespace loopmark::io
