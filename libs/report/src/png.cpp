// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <png.h>

#include <stdexcept>

#include "loopmark/report/picture.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::report {
namespace {

/// libpng reports errors by a call that must not return.
[[noreturn]] void fail(png_structp /*png*/, png_const_charp message) {
  throw std::runtime_error(std::string("cannot encode a PNG: ") + message);
}

void ignore(png_structp /*png*/, png_const_charp /*message*/) {}

void append_bytes(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

/// Owns libpng's two structures.
struct Writer {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
  png_infop info = png_create_info_struct(png);
  Writer() = default;
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
};

}  // namespace

std::string png_bytes(const Image& image) {
  static_assert(sizeof(Colour) == 3, "a row of pixels is handed to libpng as it is");
  std::string bytes;
  const Writer writer;
  png_set_write_fn(writer.png, &bytes, append_bytes, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height),
               8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  for (std::size_t row = 0; row < image.height; ++row) {
    png_write_row(writer.png, reinterpret_cast<png_const_bytep>(&image.pixels[row * image.width]));
  }
  png_write_end(writer.png, nullptr);
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  storage::write_file_atomically(path, png_bytes(image));
}

}  // namespace loopmark::report
