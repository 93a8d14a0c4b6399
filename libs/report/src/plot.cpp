// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/plot.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace loopmark::report {
namespace {

void require_same_length(const std::string& label, std::size_t a, std::size_t b) {
  if (a != b) {
    throw std::invalid_argument("plot: the vectors of series '" + label + "' differ in length: " + std::to_string(a) +
                                " and " + std::to_string(b));
  }
}

Plot::ColourBar bar_over(const std::string& label, const std::vector<double>& values) {
  Plot::ColourBar bar{label, 0.0, 1.0};
  bool first = true;
  for (const double value : values) {
    if (std::isfinite(value)) {
      bar.low = first ? value : std::min(bar.low, value);
      bar.high = first ? value : std::max(bar.high, value);
      first = false;
    }
  }
  if (bar.high <= bar.low) {
    bar.high = bar.low + 1.0;
  }
  return bar;
}

}  // namespace

Plot::Plot(std::string title, std::string x_label, std::string y_label) {
  content_.title = std::move(title);
  content_.x.label = std::move(x_label);
  content_.y.label = std::move(y_label);
}

Plot::Item& Plot::add(Kind kind, std::string label, Style style) {
  Item& item = content_.items.emplace_back();
  item.kind = kind;
  item.label = std::move(label);
  item.style = style;
  item.colour = style.colour ? *style.colour : palette(colours_used_++);
  return item;
}

Plot& Plot::line(std::string label, std::vector<double> x, std::vector<double> y, Style style) {
  require_same_length(label, x.size(), y.size());
  Item& item = add(Kind::kLine, std::move(label), style);
  item.x = std::move(x);
  item.y = std::move(y);
  return *this;
}

Plot& Plot::points(std::string label, std::vector<double> x, std::vector<double> y, Style style) {
  line(std::move(label), std::move(x), std::move(y), style);
  content_.items.back().kind = Kind::kPoints;
  return *this;
}

Plot& Plot::coloured_points(std::string label, std::vector<double> x, std::vector<double> y, std::vector<double> value,
                            Style style) {
  require_same_length(label, x.size(), value.size());
  content_.colour_bar = bar_over(label, value);
  style.colour = style.colour.value_or(kGrey);
  points("", std::move(x), std::move(y), style);
  content_.items.back().kind = Kind::kColoured;
  content_.items.back().value = std::move(value);
  return *this;
}

Plot& Plot::band(std::string label, std::vector<double> x, std::vector<double> low, std::vector<double> high,
                 Style style) {
  require_same_length(label, x.size(), high.size());
  line(std::move(label), std::move(x), std::move(low), style);
  content_.items.back().kind = Kind::kBand;
  content_.items.back().high = std::move(high);
  return *this;
}

Plot& Plot::intervals(std::string label, std::vector<double> x, std::vector<double> low, std::vector<double> high,
                      Style style) {
  band(std::move(label), std::move(x), std::move(low), std::move(high), style);
  content_.items.back().kind = Kind::kIntervals;
  return *this;
}

Plot& Plot::bars(std::string label, std::vector<double> edges, std::vector<double> heights, Style style) {
  require_same_length(label, edges.size(), heights.size() + 1);
  Item& item = add(Kind::kBars, std::move(label), style);
  item.x = std::move(edges);
  item.y = std::move(heights);
  return *this;
}

Plot& Plot::category_bars(std::string label, std::vector<double> heights, Style style) {
  add(Kind::kCategoryBars, std::move(label), style).y = std::move(heights);
  return *this;
}

Plot& Plot::polygon(std::string label, std::vector<double> x, std::vector<double> y, Style style) {
  line(std::move(label), std::move(x), std::move(y), style);
  content_.items.back().kind = Kind::kPolygon;
  return *this;
}

Plot& Plot::segments(std::string label, std::vector<double> x, std::vector<double> y, Style style) {
  line(std::move(label), std::move(x), std::move(y), style);
  content_.items.back().kind = Kind::kSegments;
  return *this;
}

Plot& Plot::image(Image picture, const Window& window) {
  Style style;
  style.colour = kGrey;
  Item& item = add(Kind::kImage, "", style);
  item.picture = std::move(picture);
  item.window = window;
  item.x = {window.left, window.right};
  item.y = {window.bottom, window.top};
  return *this;
}

Plot& Plot::heat_map(std::string label, std::vector<double> values, std::size_t columns, const Window& window) {
  if (columns == 0 || values.empty() || values.size() % columns != 0) {
    throw std::invalid_argument("plot: heat map '" + label + "' is not made of whole rows");
  }
  const ColourBar bar = bar_over(label, values);
  const std::size_t rows = values.size() / columns;
  Image picture(columns, rows);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const double value = values[row * columns + column];
      if (std::isfinite(value)) {
        picture.at(column, rows - 1 - row) = heat_colour((value - bar.low) / (bar.high - bar.low));
      }
    }
  }
  content_.colour_bar = bar;
  return image(std::move(picture), window);
}

Plot& Plot::text(std::string words, double x, double y) {
  Style style;
  style.colour = kInk;
  Item& item = add(Kind::kText, "", style);
  item.x = {x};
  item.y = {y};
  item.label = std::move(words);
  return *this;
}

Plot& Plot::categories(std::vector<std::string> names) {
  content_.categories = std::move(names);
  return *this;
}

Plot& Plot::equal_axes() {
  content_.equal = true;
  return *this;
}

Plot& Plot::x_range(double low, double high) {
  content_.x.low = low;
  content_.x.high = high;
  return *this;
}

Plot& Plot::y_range(double low, double high) {
  content_.y.low = low;
  content_.y.high = high;
  return *this;
}

Plot& Plot::log_x() {
  content_.x.logarithmic = true;
  return *this;
}

Plot& Plot::log_y() {
  content_.y.logarithmic = true;
  return *this;
}

Plot& Plot::size(double width_px, double height_px) {
  content_.width = width_px;
  content_.height = height_px;
  return *this;
}

Histogram histogram(const std::vector<double>& values, double low, double high, std::size_t bins) {
  if (bins == 0 || !(low < high)) {
    throw std::invalid_argument("histogram: needs bins and low < high");
  }
  Histogram result;
  const double width = (high - low) / static_cast<double>(bins);
  for (std::size_t i = 0; i <= bins; ++i) {
    result.edges.push_back(i == bins ? high : low + static_cast<double>(i) * width);
  }
  result.counts.assign(bins, 0.0);
  for (const double value : values) {
    if (value >= low && value <= high) {
      const auto bin = static_cast<std::size_t>((value - low) / width);
      result.counts[std::min(bin, bins - 1)] += 1.0;
    }
  }
  return result;
}

}  // namespace loopmark::report
