// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "font.hpp"
#include "loopmark/report/picture.hpp"

namespace loopmark::report {

Image::Image(std::size_t image_width, std::size_t image_height, Colour fill)
    : width(image_width), height(image_height), pixels(image_width * image_height, fill) {}

void paste(Image& image, const Image& part, std::size_t column, std::size_t row) {
  for (std::size_t r = 0; r < part.height && row + r < image.height; ++r) {
    for (std::size_t c = 0; c < part.width && column + c < image.width; ++c) {
      image.at(column + c, row + r) = part.at(c, r);
    }
  }
}

void draw_text(Image& image, const std::string& text, std::size_t column, std::size_t row, Colour colour,
               std::size_t scale) {
  for (const char letter : text) {
    const internal::Glyph& glyph = internal::glyph_of(letter);
    for (std::size_t y = 0; y < internal::kGlyphHeight * scale; ++y) {
      for (std::size_t x = 0; x < internal::kGlyphWidth * scale; ++x) {
        const bool set = (glyph[x / scale] >> (y / scale) & 1U) != 0;
        if (set && column + x < image.width && row + y < image.height) {
          image.at(column + x, row + y) = colour;
        }
      }
    }
    column += (internal::kGlyphWidth + 1) * scale;
  }
}

}  // namespace loopmark::report
