// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "loopmark/report/picture.hpp"

namespace loopmark::report {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr std::size_t kCaptionHeight = 26;
constexpr std::size_t kGap = 8;

struct Panel {
  std::string caption;
  Pose T_target_source;
};

std::vector<CloudLayer> layers_of(const Points& source, const Points& target, const Pose& T_target_source) {
  return {{target, Pose::Identity(), palette(0)}, {source, T_target_source, palette(1)}};
}

/// Both clouds seen one way under each panel's motion, side by side, all with the window that fits the last panel.
Image panel_row(const Points& source, const Points& target, const std::vector<Panel>& panels, View view,
                std::size_t width) {
  const Window window = fitting_window(layers_of(source, target, panels.back().T_target_source), view);
  const std::size_t panel_width = (width - kGap * (panels.size() - 1)) / panels.size();
  Image row;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Image drawn = draw_clouds(layers_of(source, target, panels[i].T_target_source), view, window, panel_width);
    if (i == 0) {
      row = Image(width, drawn.height + kCaptionHeight);
    }
    const std::size_t column = i * (panel_width + kGap);
    const std::string way = view == View::kAbove ? ", from above" : ", from the side";
    draw_text(row, panels[i].caption + way, column + 4, 6, kInk);
    paste(row, drawn, column, kCaptionHeight);
  }
  return row;
}

Image panels_picture(const Points& source, const Points& target, const std::vector<Panel>& panels, std::size_t width) {
  const Image above = panel_row(source, target, panels, View::kAbove, width);
  const Image side = panel_row(source, target, panels, View::kSide, width);
  Image whole(width, kCaptionHeight + above.height + side.height);
  draw_text(whole, "target", 4, 6, palette(0));
  draw_text(whole, "source", 4 + 8 * 12, 6, palette(1));
  paste(whole, above, 0, kCaptionHeight);
  paste(whole, side, 0, kCaptionHeight + above.height);
  return whole;
}

}  // namespace

Image registration_picture(const Points& source, const Points& target, const Pose& T_target_source, std::size_t width) {
  return panels_picture(source, target, {{"before", Pose::Identity()}, {"after", T_target_source}}, width);
}

Image failure_picture(const Points& source, const Points& target, const Pose& T_answered, const Pose& T_true,
                      std::size_t width) {
  return panels_picture(source, target, {{"answered", T_answered}, {"true", T_true}}, width);
}

}  // namespace loopmark::report
