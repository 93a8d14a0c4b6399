// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// From the values of a plot to pixels: ranges of the axes and the rectangle they cover.
#pragma once

#include <string>
#include <vector>

#include "loopmark/report/plot.hpp"
#include "loopmark/report/ticks.hpp"

namespace loopmark::report::internal {

/// One axis: values in [low, high] lie between two pixels.
struct Scale {
  double low = 0.0, high = 1.0;
  bool logarithmic = false;
  double from_px = 0.0, to_px = 1.0;

  double operator()(double value) const;  ///< not finite where the value cannot be shown
};

/// Where everything of a plot stands; pixels from the upper left corner.
struct Frame {
  Scale x, y;
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;  ///< the rectangle of the data
  double width = 0.0, height = 0.0;                         ///< of the whole
  double legend_top = 0.0;
  double label_drop = 0.0;  ///< height of the numbers or names below the x axis
  bool slanted = false;     ///< names of categories are too long to stand level
  std::vector<Tick> x_ticks, y_ticks;
};

/// One entry of the legend and where it stands.
struct LegendEntry {
  const Plot::Item* item = nullptr;
  double x = 0.0, y = 0.0;
};

/// About how wide a text is at a size of letters, both in pixels.
double text_width(const std::string& text, double size);

inline constexpr double kTitleSize = 14.0;
inline constexpr double kLabelSize = 12.0;
inline constexpr double kTickSize = 11.0;
inline constexpr double kLegendRow = 17.0;

/// The legend's entries in rows below `top`, between left and right.
std::vector<LegendEntry> lay_out_legend(const Plot::Content& content, double left, double right, double top);

Frame lay_out(const Plot::Content& content);

}  // namespace loopmark::report::internal
