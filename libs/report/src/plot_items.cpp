// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "svg.hpp"
#include "text.hpp"

namespace loopmark::report {
namespace {

using Item = Plot::Item;

std::vector<double> pixels(const internal::Scale& scale, const std::vector<double>& values) {
  std::vector<double> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), scale);
  return result;
}

/// The pixel of zero, or of the end of the axis that is nearest to it.
double base_line(const internal::Frame& frame) {
  const double zero = frame.y.logarithmic ? frame.y.low : std::clamp(0.0, frame.y.low, frame.y.high);
  return frame.y(zero);
}

void draw_bar(internal::SvgWriter& svg, const internal::Frame& frame, const Item& item, double left, double right,
              double height) {
  const double y = frame.y(height);
  if (std::isfinite(y)) {
    const double base = base_line(frame);
    svg.rectangle(left, std::min(y, base), right - left, std::abs(base - y),
                  internal::density_ratio_of(item, 0.75) + " stroke=\"" + hex(item.colour) + "\" stroke-width=\"0.6\"");
  }
}

void draw_points(internal::SvgWriter& svg, const internal::Frame& frame, const Item& item) {
  svg.raw("<g " + internal::density_ratio_of(item, 1.0) + ">");
  for (std::size_t i = 0; i < item.x.size(); ++i) {
    svg.circle(frame.x(item.x[i]), frame.y(item.y[i]), item.style.radius, "");
  }
  svg.raw("</g>");
}

void draw_coloured(internal::SvgWriter& svg, const internal::Frame& frame, const Item& item,
                   const Plot::ColourBar& bar) {
  for (std::size_t i = 0; i < item.x.size(); ++i) {
    if (std::isfinite(item.value[i])) {
      const Colour colour = heat_colour((item.value[i] - bar.low) / (bar.high - bar.low));
      svg.circle(frame.x(item.x[i]), frame.y(item.y[i]), item.style.radius, "fill=\"" + hex(colour) + "\"");
    }
  }
}

/// A filled band for each run of finite values.
void draw_band(internal::SvgWriter& svg, const internal::Frame& frame, const Item& item) {
  std::vector<double> x, y, back_x, back_y;
  const auto flush = [&] {
    x.insert(x.end(), back_x.rbegin(), back_x.rend());
    y.insert(y.end(), back_y.rbegin(), back_y.rend());
    svg.path(x, y, true, internal::density_ratio_of(item, 0.25) + " stroke=\"none\"");
    x.clear(), y.clear(), back_x.clear(), back_y.clear();
  };
  for (std::size_t i = 0; i < item.x.size(); ++i) {
    const double px = frame.x(item.x[i]);
    const double low = frame.y(item.y[i]);
    const double high = frame.y(item.high[i]);
    if (!std::isfinite(px) || !std::isfinite(low) || !std::isfinite(high)) {
      flush();
      continue;
    }
    x.push_back(px), y.push_back(low), back_x.push_back(px), back_y.push_back(high);
  }
  flush();
}

void draw_intervals(internal::SvgWriter& svg, const internal::Frame& frame, const Item& item) {
  constexpr double kCap = 3.5;
  for (std::size_t i = 0; i < item.x.size(); ++i) {
    const double x = frame.x(item.x[i]);
    const double low = frame.y(item.y[i]);
    const double high = frame.y(item.high[i]);
    if (std::isfinite(x) && std::isfinite(low) && std::isfinite(high)) {
      svg.line(x, low, x, high, internal::stroke_of(item));
      svg.line(x - kCap, low, x + kCap, low, internal::stroke_of(item));
      svg.line(x - kCap, high, x + kCap, high, internal::stroke_of(item));
    }
  }
}

void draw_segments(internal::SvgWriter& svg, const internal::Frame& frame, const Item& item) {
  std::string d;
  for (std::size_t i = 0; i + 1 < item.x.size(); i += 2) {
    const std::vector<double> at = {frame.x(item.x[i]), frame.y(item.y[i]), frame.x(item.x[i + 1]),
                                    frame.y(item.y[i + 1])};
    if (std::all_of(at.begin(), at.end(), [](double v) { return std::isfinite(v); })) {
      d += "M" + internal::coordinate(at[0]) + " " + internal::coordinate(at[1]) + "L" + internal::coordinate(at[2]) +
           " " + internal::coordinate(at[3]);
    }
  }
  if (!d.empty()) {
    svg.raw("<path d=\"" + d + "\" " + internal::stroke_of(item) + "/>");
  }
}

void draw_image(internal::SvgWriter& svg, const internal::Frame& frame, const Item& item) {
  const double left = frame.x(item.window.left);
  const double top = frame.y(item.window.top);
  svg.raw("<image x=\"" + internal::coordinate(left) + "\" y=\"" + internal::coordinate(top) + "\" width=\"" +
          internal::coordinate(frame.x(item.window.right) - left) + "\" height=\"" +
          internal::coordinate(frame.y(item.window.bottom) - top) +
          "\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" href=\"" +
          internal::png_data_uri(png_bytes(item.picture)) + "\"/>");
}

}  // namespace

void internal::draw_item(internal::SvgWriter& svg, const internal::Frame& frame, const Plot::Content& content,
                         const Item& item, std::size_t bar_slot, std::size_t bar_slots) {
  switch (item.kind) {
    case Plot::Kind::kLine:
      svg.path(pixels(frame.x, item.x), pixels(frame.y, item.y), false, internal::stroke_of(item));
      break;
    case Plot::Kind::kPoints:
      draw_points(svg, frame, item);
      break;
    case Plot::Kind::kColoured:
      draw_coloured(svg, frame, item, *content.colour_bar);
      break;
    case Plot::Kind::kBand:
      draw_band(svg, frame, item);
      break;
    case Plot::Kind::kIntervals:
      draw_intervals(svg, frame, item);
      break;
    case Plot::Kind::kBars:
      for (std::size_t i = 0; i < item.y.size(); ++i) {
        draw_bar(svg, frame, item, frame.x(item.x[i]), frame.x(item.x[i + 1]), item.y[i]);
      }
      break;
    case Plot::Kind::kCategoryBars:
      for (std::size_t i = 0; i < item.y.size(); ++i) {
        const double width = 0.8 / static_cast<double>(bar_slots);
        const double left = static_cast<double>(i) - 0.4 + width * static_cast<double>(bar_slot);
        draw_bar(svg, frame, item, frame.x(left), frame.x(left + width), item.y[i]);
      }
      break;
    case Plot::Kind::kPolygon:
      svg.path(pixels(frame.x, item.x), pixels(frame.y, item.y), true,
               internal::density_ratio_of(item, 0.2) + " stroke=\"" + hex(item.colour) + "\" stroke-width=\"" +
                   internal::coordinate(item.style.width) + "\"");
      break;
    case Plot::Kind::kSegments:
      draw_segments(svg, frame, item);
      break;
    case Plot::Kind::kImage:
      draw_image(svg, frame, item);
      break;
    case Plot::Kind::kText:
      svg.words(item.label, frame.x(item.x[0]), frame.y(item.y[0]), internal::kTickSize, internal::Anchor::kMiddle);
      break;
  }
}

}  // namespace loopmark::report
