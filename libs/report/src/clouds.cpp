// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "loopmark/report/picture.hpp"

namespace loopmark::report {
namespace {

Eigen::Vector2d project(const Eigen::Vector3d& p, View view) {
  return view == View::kAbove ? Eigen::Vector2d(p.x(), p.y()) : Eigen::Vector2d(p.x(), p.z());
}

/// Calls use(u, v) for every finite point of a layer, in the picture's plane.
template <class Use>
void for_each_point(const CloudLayer& layer, View view, const Use& use) {
  for (const Eigen::Vector3f& point : layer.points) {
    const Eigen::Vector2d p = project(layer.T_picture_layer * point.cast<double>(), view);
    if (p.allFinite()) {
      use(p);
    }
  }
}

/// The range that leaves out one half percent of the values at either end; sorts partly.
std::pair<double, double> inner_range(std::vector<double>& values) {
  if (values.empty()) {
    return {-1.0, 1.0};
  }
  const std::size_t skip = values.size() / 200;
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(skip);
  const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(skip);
  std::nth_element(values.begin(), low, values.end());
  const double least = *low;
  std::nth_element(values.begin(), high, values.end());
  return {least, *high};
}

constexpr double kMargin = 0.04;
/// Points in a pixel after which the colour has reached 63 % of its strength.
constexpr double kSaturation = 1.5;

}  // namespace

Window fitting_window(const std::vector<CloudLayer>& layers, View view) {
  std::vector<double> u;
  std::vector<double> v;
  for (const CloudLayer& layer : layers) {
    for_each_point(layer, view, [&](const Eigen::Vector2d& p) {
      u.push_back(p.x());
      v.push_back(p.y());
    });
  }
  const auto [left, right] = inner_range(u);
  const auto [bottom, top] = inner_range(v);
  const double margin = kMargin * std::max({right - left, top - bottom, 1.0});
  return {left - margin, right + margin, bottom - margin, top + margin};
}

Image draw_clouds(const std::vector<CloudLayer>& layers, View view, const Window& window, std::size_t width) {
  const double scale = static_cast<double>(width) / (window.right - window.left);
  const auto rows = static_cast<std::size_t>(std::lround(scale * (window.top - window.bottom)));
  Image image(width, std::clamp<std::size_t>(rows, 1, 2 * width));
  for (const CloudLayer& layer : layers) {
    std::vector<std::uint32_t> counts(image.pixels.size(), 0);
    for_each_point(layer, view, [&](const Eigen::Vector2d& p) {
      const double column = std::floor(scale * (p.x() - window.left));
      const double row = std::floor(scale * (window.top - p.y()));
      if (column >= 0 && row >= 0 && column < static_cast<double>(image.width) &&
          row < static_cast<double>(image.height)) {
        ++counts[static_cast<std::size_t>(row) * image.width + static_cast<std::size_t>(column)];
      }
    });
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] > 0) {
        image.pixels[i] =
            mix(image.pixels[i], layer.colour, 1.0 - std::exp(-static_cast<double>(counts[i]) / kSaturation));
      }
    }
  }
  return image;
}

}  // namespace loopmark::report
