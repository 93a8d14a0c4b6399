// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Pictures made of pixels: clouds from above and from the side, written as PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/report/colour.hpp"

namespace loopmark::report {

/// Pixels row by row from the top, 8 bits a channel.
struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Colour> pixels;

  Image() = default;
  Image(std::size_t image_width, std::size_t image_height, Colour fill = kWhite);
  Colour& at(std::size_t column, std::size_t row) { return pixels[row * width + column]; }
  const Colour& at(std::size_t column, std::size_t row) const { return pixels[row * width + column]; }
};

/// The image as a PNG file's bytes; the same image gives the same bytes.
std::string png_bytes(const Image& image);

/// Writes png_bytes whole or not at all. Throws InputError naming the file.
void write_png(const std::filesystem::path& path, const Image& image);

/// Copies `part` into `image` with its upper left corner at (column, row); what stands out is cut off.
void paste(Image& image, const Image& part, std::size_t column, std::size_t row);

/// Writes text (ASCII; others as '?') with its upper left corner at (column, row); letters are 5 x 7 pixels, `scale`
/// times as large, 6 * scale apart.
void draw_text(Image& image, const std::string& text, std::size_t column, std::size_t row, Colour colour,
               std::size_t scale = 2);

/// A cloud and how it is shown.
struct CloudLayer {
  std::vector<Eigen::Vector3f> points;  ///< in the layer's own frame, metres
  Pose T_picture_layer = Pose::Identity();
  Colour colour;
};

enum class View {
  kAbove,  ///< x to the right, y up
  kSide,   ///< x to the right, z up
};

/// Which part of space a picture shows, in the picture's frame, metres. The scale is the same along both axes.
struct Window {
  double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;
};

/// The window that holds all but the outermost 1 % of the points along each axis, with a margin.
Window fitting_window(const std::vector<CloudLayer>& layers, View view);

/// Draws the layers over each other, `width` pixels wide: the more points in a pixel, the stronger the colour. The
/// height follows from the window, at most 2 * width.
Image draw_clouds(const std::vector<CloudLayer>& layers, View view, const Window& window, std::size_t width);

/// Two clouds before (both in their own frames laid over each other) and after the motion, from above and from the
/// side: four panels with captions. `width`: pixels of the whole.
Image registration_picture(const std::vector<Eigen::Vector3f>& source, const std::vector<Eigen::Vector3f>& target,
                           const Pose& T_target_source, std::size_t width = 1200);

/// Two clouds under one of several motions.
struct MotionPanel {
  std::string caption;
  Pose T_target_source = Pose::Identity();
};

/// The two clouds under each motion, side by side with captions, from above and from the side; all with the window that
/// fits the last: what is true beside what was answered, for a pair that failed.
Image motions_picture(const std::vector<Eigen::Vector3f>& source, const std::vector<Eigen::Vector3f>& target,
                      const std::vector<MotionPanel>& panels, std::size_t width = 1200);

}  // namespace loopmark::report
