// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace loopmark::report::internal {
namespace {

constexpr double kPad = 0.04;  ///< of the range, left free around the data

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void hold(double value, bool logarithmic) {
    if (std::isfinite(value) && (!logarithmic || value > 0.0)) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  void hold(const std::vector<double>& values, bool logarithmic) {
    for (const double value : values) {
      hold(value, logarithmic);
    }
  }
};

bool stands_on_zero(Plot::Kind kind) { return kind == Plot::Kind::kBars || kind == Plot::Kind::kCategoryBars; }

Scale finished(Range range, const Plot::Axis& axis, bool pad_low, bool pad_high) {
  if (!(range.low <= range.high)) {
    range.low = axis.logarithmic ? 0.1 : 0.0;
    range.high = 1.0;
  }
  Scale scale;
  scale.logarithmic = axis.logarithmic;
  if (axis.logarithmic) {
    const double factor = std::max(std::pow(range.high / range.low, kPad), 1.2);
    scale.low = range.low / factor;
    scale.high = range.high * factor;
  } else {
    const double spread = range.high - range.low;
    const double pad = spread > 0.0 ? kPad * spread : std::max(0.5, 0.05 * std::abs(range.high));
    scale.low = range.low - (pad_low || spread <= 0.0 ? pad : 0.0);
    scale.high = range.high + (pad_high || spread <= 0.0 ? pad : 0.0);
  }
  scale.low = axis.low.value_or(scale.low);
  scale.high = axis.high.value_or(scale.high);
  return scale;
}

Scale x_scale(const Plot::Content& content) {
  Range range;
  bool picture = false;
  for (const Plot::Item& item : content.items) {
    range.hold(item.x, content.x.logarithmic);
    picture = picture || item.kind == Plot::Kind::kImage;
  }
  if (!content.categories.empty()) {
    range.hold(-0.5, false);
    range.hold(static_cast<double>(content.categories.size()) - 0.5, false);
  }
  const bool pad = !picture && content.categories.empty();
  return finished(range, content.x, pad, pad);
}

Scale y_scale(const Plot::Content& content) {
  Range range;
  bool picture = false;
  bool on_zero = false;
  for (const Plot::Item& item : content.items) {
    range.hold(item.y, content.y.logarithmic);
    range.hold(item.high, content.y.logarithmic);
    picture = picture || item.kind == Plot::Kind::kImage;
    on_zero = on_zero || stands_on_zero(item.kind);
  }
  if (on_zero) {
    range.hold(0.0, content.y.logarithmic);
  }
  const bool from_zero = on_zero && range.low >= 0.0;
  return finished(range, content.y, !picture && !from_zero, !picture);
}

/// Widens the range whose pixels are longer than the other's scale allows, about its middle.
void equalise(Frame& frame) {
  const double x_px = frame.right - frame.left;
  const double y_px = frame.bottom - frame.top;
  const double metres_per_px = std::max((frame.x.high - frame.x.low) / x_px, (frame.y.high - frame.y.low) / y_px);
  const auto widen = [&](Scale& scale, double px) {
    const double middle = 0.5 * (scale.low + scale.high);
    scale.low = middle - 0.5 * metres_per_px * px;
    scale.high = middle + 0.5 * metres_per_px * px;
  };
  widen(frame.x, x_px);
  widen(frame.y, y_px);
}

std::vector<Tick> ticks_of(const Scale& scale, double px, double px_per_tick) {
  if (scale.logarithmic) {
    return logarithmic_ticks(scale.low, scale.high);
  }
  return linear_ticks(scale.low, scale.high, static_cast<std::size_t>(std::max(2.0, px / px_per_tick)));
}

std::vector<Tick> category_ticks(const std::vector<std::string>& names) {
  std::vector<Tick> ticks;
  for (std::size_t i = 0; i < names.size(); ++i) {
    ticks.push_back({static_cast<double>(i), names[i]});
  }
  return ticks;
}

double widest(const std::vector<Tick>& ticks) {
  double width = 0.0;
  for (const Tick& tick : ticks) {
    width = std::max(width, text_width(tick.label, kTickSize));
  }
  return width;
}

/// A legend of more rows than this makes the plot higher instead of its axes shorter.
constexpr double kLegendRowsWithin = 2.0;

void lay_out_vertically(const Plot::Content& content, Frame& frame) {
  frame.legend_top = content.title.empty() ? 6.0 : 28.0;
  const auto legend = lay_out_legend(content, 12.0, content.width - 12.0, frame.legend_top);
  frame.top = (legend.empty() ? frame.legend_top : legend.back().y + kLegendRow) + 8.0;
  frame.height += std::max(0.0, frame.top - frame.legend_top - 8.0 - kLegendRowsWithin * kLegendRow);
  frame.label_drop = 18.0;
  if (!content.categories.empty()) {
    const double names = widest(category_ticks(content.categories));
    const double slot = (content.width - 90.0) / static_cast<double>(content.categories.size());
    frame.slanted = names > slot - 8.0;
    frame.label_drop = frame.slanted ? 14.0 + names * std::sin(std::numbers::pi / 6.0) : 18.0;
  }
  frame.bottom = frame.height - frame.label_drop - (content.x.label.empty() ? 4.0 : 22.0);
}

}  // namespace

double Scale::operator()(double value) const {
  const double share = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return from_px + share * (to_px - from_px);
}

double text_width(const std::string& text, double size) {
  double letters = 0.0;
  for (const char c : text) {
    const bool continues = (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;  // UTF-8
    letters += continues ? 0.0 : (c == 'i' || c == 'l' || c == '.' || c == ',' || c == ' ') ? 0.34 : 0.6;
  }
  return letters * size;
}

std::vector<LegendEntry> lay_out_legend(const Plot::Content& content, double left, double right, double top) {
  std::vector<LegendEntry> entries;
  double x = left;
  double y = top;
  for (const Plot::Item& item : content.items) {
    if (item.label.empty() || item.kind == Plot::Kind::kText) {
      continue;
    }
    const double width = 26.0 + text_width(item.label, kTickSize) + 16.0;
    if (x > left && x + width > right) {
      x = left;
      y += kLegendRow;
    }
    entries.push_back({&item, x, y});
    x += width;
  }
  return entries;
}

Frame lay_out(const Plot::Content& content) {
  Frame frame;
  frame.width = content.width;
  frame.height = content.height;
  frame.x = x_scale(content);
  frame.y = y_scale(content);
  lay_out_vertically(content, frame);
  frame.y_ticks = ticks_of(frame.y, frame.bottom - frame.top, 48.0);
  frame.left = 14.0 + (content.y.label.empty() ? 0.0 : 18.0) + widest(frame.y_ticks);
  frame.right = content.width - (content.colour_bar ? 92.0 : 16.0);
  if (content.equal) {
    equalise(frame);
    frame.y_ticks = ticks_of(frame.y, frame.bottom - frame.top, 48.0);
  }
  frame.x_ticks = content.categories.empty() ? ticks_of(frame.x, frame.right - frame.left, 80.0)
                                             : category_ticks(content.categories);
  frame.x.from_px = frame.left;
  frame.x.to_px = frame.right;
  frame.y.from_px = frame.bottom;
  frame.y.to_px = frame.top;
  return frame;
}

}  // namespace loopmark::report::internal
