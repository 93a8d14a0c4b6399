// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "svg.hpp"

#include <cmath>

#include "text.hpp"

namespace loopmark::report::internal {
namespace {

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + coordinate(value) + "\"";
}

const char* anchor_name(Anchor anchor) {
  return anchor == Anchor::kStart ? "start" : anchor == Anchor::kMiddle ? "middle" : "end";
}

}  // namespace

void SvgWriter::rectangle(double x, double y, double width, double height, const std::string& style) {
  raw("<rect" + attribute("x", x) + attribute("y", y) + attribute("width", std::max(width, 0.0)) +
      attribute("height", std::max(height, 0.0)) + " " + style + "/>");
}

void SvgWriter::line(double x1, double y1, double x2, double y2, const std::string& style) {
  raw("<line" + attribute("x1", x1) + attribute("y1", y1) + attribute("x2", x2) + attribute("y2", y2) + " " + style +
      "/>");
}

void SvgWriter::path(const std::vector<double>& x, const std::vector<double>& y, bool closed, const std::string& style,
                     double least_px) {
  std::string d;
  bool pen_up = true;
  double last_x = 0.0;
  double last_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      pen_up = true;
      continue;
    }
    const bool last = i + 1 == x.size();
    if (!pen_up && !last && std::hypot(x[i] - last_x, y[i] - last_y) < least_px) {
      continue;
    }
    d += (pen_up ? "M" : "L") + coordinate(x[i]) + " " + coordinate(y[i]);
    pen_up = false;
    last_x = x[i];
    last_y = y[i];
  }
  if (!d.empty()) {
    raw("<path d=\"" + d + (closed ? "Z" : "") + "\" " + style + "/>");
  }
}

void SvgWriter::circle(double x, double y, double radius, const std::string& style) {
  if (std::isfinite(x) && std::isfinite(y)) {
    raw("<circle" + attribute("cx", x) + attribute("cy", y) + attribute("r", radius) +
        (style.empty() ? "" : " " + style) + "/>");
  }
}

void SvgWriter::words(const std::string& text, double x, double y, double size, Anchor anchor, const std::string& style,
                      double turn) {
  std::string element = "<text" + attribute("x", x) + attribute("y", y) + attribute("font-size", size) +
                        " text-anchor=\"" + anchor_name(anchor) + "\"";
  if (turn != 0.0) {
    element += " transform=\"rotate(" + coordinate(turn) + " " + coordinate(x) + " " + coordinate(y) + ")\"";
  }
  raw(element + (style.empty() ? "" : " " + style) + ">" + escape_markup(text) + "</text>");
}

std::string stroke_of(const Plot::Item& item) {
  return "fill=\"none\" stroke=\"" + hex(item.colour) + "\" stroke-width=\"" + coordinate(item.style.width) +
         "\" stroke-linejoin=\"round\"" + (item.style.dashed ? " stroke-dasharray=\"6 4\"" : "") +
         (item.style.opacity < 1.0 ? " stroke-opacity=\"" + coordinate(item.style.opacity) + "\"" : "");
}

std::string density_ratio_of(const Plot::Item& item, double opacity) {
  return "fill=\"" + hex(item.colour) + "\" fill-opacity=\"" + coordinate(item.style.opacity * opacity) + "\"";
}

}  // namespace loopmark::report::internal
