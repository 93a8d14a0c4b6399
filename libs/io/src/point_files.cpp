// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "loopmark/text/text.hpp"
#include "point_columns.hpp"
#include "point_formats.hpp"

namespace loopmark::io {
namespace {

const char* const kCopyAgain = "copy the file again, or leave it out";

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

internal::FileBytes::FileBytes(const std::filesystem::path& path) {
  const Descriptor file(path);
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0) {
    throw DamagedScan(path.string(), "", std::string("cannot read: ") + std::strerror(errno));
  }
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0) {
    throw DamagedScan(path.string(), "byte 0", "the file is empty", kCopyAgain);
  }
  data_.reset(new char[size_]);  // make_unique would clear the memory first
  std::size_t done = 0;
  while (done < size_) {
    const ssize_t got = ::read(file.get(), data_.get() + done, size_ - done);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      throw DamagedScan(path.string(), "byte " + std::to_string(done),
                        std::string("cannot read: ") + (got < 0 ? std::strerror(errno) : "the file shrank"));
    }
    done += static_cast<std::size_t>(got);
  }
}

void internal::throw_truncated(const std::string& file, std::size_t bytes_there, std::size_t bytes_needed) {
  throw DamagedScan(file, "byte " + std::to_string(bytes_there),
                    "truncated: " + std::to_string(bytes_needed) + " bytes are needed", kCopyAgain);
}

PointFile internal::read_bin(std::span<const char> bytes, std::size_t columns, const std::string& file,
                             const LogOptions& options) {
  const std::size_t stride = columns * sizeof(float);
  if (columns < 3 || columns > 6) {
    throw InputError("option bin_columns: 3 to 6 columns can be read: x y z intensity ring time");
  }
  if (bytes.size() % stride != 0) {
    throw DamagedScan(file, "byte " + std::to_string(bytes.size() / stride * stride),
                      "truncated: the size is no multiple of " + std::to_string(stride) + " bytes a point",
                      std::string(kCopyAgain) + "; or set bin_columns where points have other than " +
                          std::to_string(columns) + " values");
  }
  internal::PointColumns table;
  table.count = bytes.size() / stride;
  const std::array<internal::Column*, 6> order = {&table.x,         &table.y,    &table.z,
                                                  &table.intensity, &table.ring, &table.time};
  for (std::size_t c = 0; c < columns; ++c) {
    *order[c] = {bytes.data() + c * sizeof(float), stride, internal::NumberType::kFloat32};
  }
  return internal::decode_points(table, options);
}

std::vector<double> internal::read_ascii_table(std::span<const char> bytes, std::size_t rows, std::size_t columns,
                                               const std::string& file, std::size_t first_line) {
  std::vector<double> values;
  values.reserve(std::min(rows * columns, bytes.size()));
  const char* at = bytes.data();
  const char* const end = at + bytes.size();
  std::size_t line = first_line;
  while (values.size() < rows * columns) {
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n')) {
      line += *at++ == '\n' ? 1 : 0;
    }
    if (at == end) {
      throw DamagedScan(file, "line " + std::to_string(line),
                        "truncated: " + std::to_string(rows) + " points are promised, " +
                            std::to_string(values.size() / columns) + " are there",
                        kCopyAgain);
    }
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) {
      throw DamagedScan(file, "line " + std::to_string(line), "not a number");
    }
    at = next;
    values.push_back(value);
  }
  return values;
}

PointFile read_point_file(const std::filesystem::path& path, const LogOptions& options) {
  const std::string file = path.string();
  const std::string name = text::lower_case(path.filename().string());
  const internal::FileBytes content(path);
  if (name.ends_with(".pcd")) {
    return internal::read_pcd(content.bytes(), file, options);
  }
  if (name.ends_with(".ply")) {
    return internal::read_ply(content.bytes(), file, options);
  }
  if (name.ends_with(".bin")) {
    const std::size_t guess = name.ends_with(".pcd.bin") ? 5 : 4;
    return internal::read_bin(content.bytes(), options.bin_columns > 0 ? options.bin_columns : guess, file, options);
  }
  throw DamagedScan(file, "", "not a point file", "known are .bin, .pcd and .ply");
}

}  // namespace loopmark::io
