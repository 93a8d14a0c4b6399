// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Plots as SVG, with no library behind them.
///
///   Plot plot("Trajectory", "x [m]", "y [m]");
///   plot.equal_axes().line("odometry", x, y).line("with loops", x2, y2);
///   page.plot(plot);
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/report/colour.hpp"
#include "loopmark/report/picture.hpp"

namespace loopmark::report {

/// How one series looks; the colour is the next of the palette unless given.
struct Style {
  std::optional<Colour> colour = std::nullopt;
  double width = 1.6;    ///< of lines, pixels
  double radius = 2.5;   ///< of points, pixels
  double opacity = 1.0;  ///< of fills and points
  bool dashed = false;
};

/// One plot with two axes. Series are drawn in the order they are added; those with a label stand in the legend.
/// Values that are not finite leave a gap. Vectors of one series must be equally long (std::invalid_argument).
class Plot {
 public:
  Plot(std::string title, std::string x_label, std::string y_label);

  Plot& line(std::string label, std::vector<double> x, std::vector<double> y, Style style = {});
  Plot& points(std::string label, std::vector<double> x, std::vector<double> y, Style style = {});
  /// Points with a colour each by `value`, with a colour bar.
  Plot& coloured_points(std::string label, std::vector<double> x, std::vector<double> y, std::vector<double> value,
                        Style style = {});
  /// A filled band between low and high.
  Plot& band(std::string label, std::vector<double> x, std::vector<double> low, std::vector<double> high,
             Style style = {});
  /// Vertical bars from low to high at x: intervals of confidence.
  Plot& intervals(std::string label, std::vector<double> x, std::vector<double> low, std::vector<double> high,
                  Style style = {});
  /// Histogram bars: heights[i] from edges[i] to edges[i + 1].
  Plot& bars(std::string label, std::vector<double> edges, std::vector<double> heights, Style style = {});
  /// Bars over named categories (see categories()), side by side when there are several series.
  Plot& category_bars(std::string label, std::vector<double> heights, Style style = {});
  /// A filled, closed outline.
  Plot& polygon(std::string label, std::vector<double> x, std::vector<double> y, Style style = {});
  /// Separate segments, x and y holding start, end, start, end, ...
  Plot& segments(std::string label, std::vector<double> x, std::vector<double> y, Style style = {});
  /// A picture that covers the window.
  Plot& image(Image picture, const Window& window);
  /// values[row * columns + column] over the window, row 0 at the bottom, with a colour bar; gaps are left white.
  Plot& heat_map(std::string label, std::vector<double> values, std::size_t columns, const Window& window);
  /// A word at a place.
  Plot& text(std::string words, double x, double y);

  Plot& categories(std::vector<std::string> names);  ///< names of x = 0, 1, 2, ...
  Plot& equal_axes();                                ///< one metre is as long along x as along y
  Plot& x_range(double low, double high);
  Plot& y_range(double low, double high);
  Plot& log_x();
  Plot& log_y();
  Plot& size(double width_px, double height_px);  ///< of the whole, default 640 x 400; a long legend adds to it

  /// The plot as one <svg> element.
  std::string svg() const;

  enum class Kind {
    kLine,
    kPoints,
    kColoured,
    kBand,
    kIntervals,
    kBars,
    kCategoryBars,
    kPolygon,
    kSegments,
    kImage,
    kText
  };
  /// One thing drawn; which vectors are filled depends on the kind.
  struct Item {
    Kind kind = Kind::kLine;
    std::string label;
    Style style;
    Colour colour;
    std::vector<double> x, y, high, value;
    Image picture;
    Window window;
  };
  /// What the colours of coloured points and heat maps mean.
  struct ColourBar {
    std::string label;
    double low = 0.0, high = 1.0;
  };
  struct Axis {
    std::string label;
    std::optional<double> low, high;
    bool logarithmic = false;
  };
  struct Content {
    std::string title;
    Axis x, y;
    bool equal = false;
    double width = 640.0, height = 400.0;
    std::vector<Item> items;
    std::vector<std::string> categories;
    std::optional<ColourBar> colour_bar;
  };
  const Content& content() const { return content_; }

 private:
  Item& add(Kind kind, std::string label, Style style);

  Content content_;
  std::size_t colours_used_ = 0;
};

/// Histogram counts of the finite values: `bins` bins of equal width over [low, high]; values outside are left out,
/// `high` itself belongs to the last. Returns the edges (bins + 1) and the counts.
struct Histogram {
  std::vector<double> edges;
  std::vector<double> counts;
};
Histogram histogram(const std::vector<double>& values, double low, double high, std::size_t bins);

}  // namespace loopmark::report
