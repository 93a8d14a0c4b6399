// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "loopmark/storage/files.hpp"
#include "svg.hpp"
#include "text.hpp"

namespace loopmark::report {
namespace {

constexpr char kGridStyle[] = "stroke=\"#e4e4e4\" stroke-width=\"1\"";
constexpr char kFaintStyle[] = "stroke=\"#f3f3f3\" stroke-width=\"1\"";
constexpr char kAxisStyle[] = "stroke=\"#888\" stroke-width=\"1\"";
constexpr char kMutedText[] = "fill=\"#555\"";

void draw_grid(internal::SvgWriter& svg, const internal::Frame& frame, bool vertical) {
  for (const Tick& tick : frame.y_ticks) {
    const double y = frame.y(tick.value);
    svg.line(frame.left, y, frame.right, y, tick.label.empty() ? kFaintStyle : kGridStyle);
    svg.words(tick.label, frame.left - 6.0, y + 4.0, internal::kTickSize, internal::Anchor::kEnd, kMutedText);
  }
  for (const Tick& tick : frame.x_ticks) {
    const double x = frame.x(tick.value);
    if (vertical) {
      svg.line(x, frame.top, x, frame.bottom, tick.label.empty() ? kFaintStyle : kGridStyle);
    }
    if (frame.slanted) {
      svg.words(tick.label, x + 3.0, frame.bottom + 13.0, internal::kTickSize, internal::Anchor::kEnd, kMutedText,
                -30.0);
    } else {
      svg.words(tick.label, x, frame.bottom + 15.0, internal::kTickSize, internal::Anchor::kMiddle, kMutedText);
    }
  }
}

void draw_labels(internal::SvgWriter& svg, const internal::Frame& frame, const Plot::Content& content) {
  svg.line(frame.left, frame.bottom, frame.right, frame.bottom, kAxisStyle);
  svg.line(frame.left, frame.top, frame.left, frame.bottom, kAxisStyle);
  const double middle_x = 0.5 * (frame.left + frame.right);
  const double middle_y = 0.5 * (frame.top + frame.bottom);
  svg.words(content.title, 12.0, 19.0, internal::kTitleSize, internal::Anchor::kStart, "font-weight=\"600\"");
  svg.words(content.x.label, middle_x, frame.bottom + frame.label_drop + 16.0, internal::kLabelSize,
            internal::Anchor::kMiddle);
  svg.words(content.y.label, 16.0, middle_y, internal::kLabelSize, internal::Anchor::kMiddle, "", -90.0);
}

void draw_legend(internal::SvgWriter& svg, const internal::Frame& frame, const Plot::Content& content) {
  for (const internal::LegendEntry& entry :
       internal::lay_out_legend(content, 12.0, frame.width - 12.0, frame.legend_top)) {
    const Plot::Item& item = *entry.item;
    const double y = entry.y + 0.5 * internal::kLegendRow;
    switch (item.kind) {
      case Plot::Kind::kPoints:
        svg.circle(entry.x + 10.0, y, 3.5, internal::density_ratio_of(item, 1.0));
        break;
      case Plot::Kind::kLine:
      case Plot::Kind::kSegments:
      case Plot::Kind::kIntervals:
        svg.line(entry.x, y, entry.x + 20.0, y, internal::stroke_of(item));
        break;
      default:
        svg.rectangle(entry.x + 3.0, y - 5.0, 14.0, 10.0,
                      internal::density_ratio_of(item, item.kind == Plot::Kind::kBand ? 0.35 : 0.75));
    }
    svg.words(item.label, entry.x + 26.0, y + 4.0, internal::kTickSize, internal::Anchor::kStart);
  }
}

void draw_colour_bar(internal::SvgWriter& svg, const internal::Frame& frame, const Plot::ColourBar& bar) {
  constexpr int kSteps = 48;
  constexpr double kWidth = 12.0;
  const double left = frame.right + 14.0;
  const internal::Scale scale{bar.low, bar.high, false, frame.bottom, frame.top};
  const double step = (frame.bottom - frame.top) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    svg.rectangle(left, frame.bottom - (i + 1) * step, kWidth, step + 0.4,
                  "fill=\"" + hex(heat_colour((i + 0.5) / kSteps)) + "\"");
  }
  for (const Tick& tick : linear_ticks(bar.low, bar.high, 6)) {
    svg.words(tick.label, left + kWidth + 4.0, scale(tick.value) + 4.0, internal::kTickSize, internal::Anchor::kStart,
              kMutedText);
  }
  svg.words(bar.label, frame.width - 8.0, 0.5 * (frame.top + frame.bottom), internal::kTickSize,
            internal::Anchor::kMiddle, "", -90.0);
}

/// A name for the clipping rectangle that is the plot's own on any page: it follows from what is drawn.
std::string clip_name(const std::string& drawn) { return "clip" + storage::sha256_hex(drawn).substr(0, 12); }

}  // namespace

std::string Plot::svg() const {
  const internal::Frame frame = internal::lay_out(content_);
  const auto is_bars = [](const Item& item) { return item.kind == Kind::kCategoryBars; };
  const auto bar_slots = static_cast<std::size_t>(std::count_if(content_.items.begin(), content_.items.end(), is_bars));
  internal::SvgWriter items;
  std::size_t bar_slot = 0;
  for (const Item& item : content_.items) {
    internal::draw_item(items, frame, content_, item, bar_slot, bar_slots);
    bar_slot += is_bars(item) ? 1 : 0;
  }
  internal::SvgWriter svg;
  const std::string size = internal::coordinate(frame.width) + "\" height=\"" + internal::coordinate(frame.height);
  svg.raw("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " +
          internal::coordinate(frame.width) + " " + internal::coordinate(frame.height) +
          "\" font-family=\"system-ui, 'DejaVu Sans', sans-serif\" fill=\"#222\" role=\"img\" aria-label=\"" +
          internal::escape_markup(content_.title) + "\">");
  svg.rectangle(0, 0, frame.width, frame.height, "fill=\"#fff\"");
  draw_grid(svg, frame, content_.categories.empty());
  const std::string clip = clip_name(items.text());
  svg.raw("<clipPath id=\"" + clip + "\">");
  svg.rectangle(frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top, "");
  svg.raw("</clipPath>\n<g clip-path=\"url(#" + clip + ")\">\n" + items.text() + "</g>");
  draw_labels(svg, frame, content_);
  draw_legend(svg, frame, content_);
  if (content_.colour_bar) {
    draw_colour_bar(svg, frame, *content_.colour_bar);
  }
  svg.raw("</svg>");
  return svg.text();
}

}  // namespace loopmark::report
