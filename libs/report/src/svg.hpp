// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "frame.hpp"
#include "loopmark/report/plot.hpp"

namespace loopmark::report::internal {

/// Where a text stands relative to its anchor.
enum class Anchor { kStart, kMiddle, kEnd };

/// Collects SVG elements; coordinates in pixels.
class SvgWriter {
 public:
  void raw(const std::string& element) { text_ += element + "\n"; }
  void rectangle(double x, double y, double width, double height, const std::string& style);
  void line(double x1, double y1, double x2, double y2, const std::string& style);
  /// Draws through the points; a point that is not finite breaks the line. Points closer than `least_px` to the one
  /// before are left out.
  void path(const std::vector<double>& x, const std::vector<double>& y, bool closed, const std::string& style,
            double least_px = 0.3);
  void circle(double x, double y, double radius, const std::string& style);
  /// `turn`: degrees clockwise about the anchor.
  void words(const std::string& text, double x, double y, double size, Anchor anchor, const std::string& style = "",
             double turn = 0.0);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// stroke of a series as attributes; fill of a series with its opacity times `opacity`.
std::string stroke_of(const Plot::Item& item);
std::string density_ratio_of(const Plot::Item& item, double opacity);

/// Draws one series inside the frame; `bar_slot` of `bar_slots` is its place among the category bars.
void draw_item(SvgWriter& svg, const Frame& frame, const Plot::Content& content, const Plot::Item& item,
               std::size_t bar_slot, std::size_t bar_slots);

}  // namespace loopmark::report::internal
