// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <stdexcept>

#include "loopmark/report/picture.hpp"

namespace loopmark::report {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr std::size_t kCaptionHeight = 26;
constexpr std::size_t kGap = 8;

std::vector<CloudLayer> layers_of(const Points& source, const Points& target, const Pose& T_target_source) {
  return {{target, Pose::Identity(), palette(0)}, {source, T_target_source, palette(1)}};
}

/// The caption with the way of looking, as far as it fits.
std::string fitting(const std::string& caption, View view, std::size_t width) {
  constexpr std::size_t kLetter = 12;
  const std::string whole = caption + (view == View::kAbove ? ", from above" : ", from the side");
  const std::size_t room = width / kLetter;
  return whole.size() <= room ? whole : caption.substr(0, room);
}

/// Both clouds seen one way under each panel's motion, side by side, all with the window that fits the last panel.
Image panel_row(const Points& source, const Points& target, const std::vector<MotionPanel>& panels, View view,
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
    draw_text(row, fitting(panels[i].caption, view, panel_width), column + 4, 6, kInk);
    paste(row, drawn, column, kCaptionHeight);
  }
  return row;
}

}  // namespace

Image motions_picture(const Points& source, const Points& target, const std::vector<MotionPanel>& panels,
                      std::size_t width) {
  if (panels.empty()) {
    throw std::invalid_argument("motions_picture: no motion is given");
  }
  const Image above = panel_row(source, target, panels, View::kAbove, width);
  const Image side = panel_row(source, target, panels, View::kSide, width);
  Image whole(width, kCaptionHeight + above.height + side.height);
  draw_text(whole, "target", 4, 6, palette(0));
  draw_text(whole, "source", 4 + 8 * 12, 6, palette(1));
  paste(whole, above, 0, kCaptionHeight);
  paste(whole, side, 0, kCaptionHeight + above.height);
  return whole;
}

Image registration_picture(const Points& source, const Points& target, const Pose& T_target_source, std::size_t width) {
  return motions_picture(source, target, {{"before", Pose::Identity()}, {"after", T_target_source}}, width);
}

}  // namespace loopmark::report
