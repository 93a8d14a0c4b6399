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
#include <limits>

#include "bin_columns.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/text/text.hpp"
#include "point_columns.hpp"
#include "point_formats.hpp"

namespace loopmark::io {
namespace {

const char* const kCopyAgain = "copy the file again, or leave it out";
constexpr std::size_t kLargestScanFile = std::size_t{1} << 30U;  // bytes; a survey scanner's 50 million points fit

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
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
  if (!S_ISREG(status.st_mode)) {
    throw DamagedScan(path.string(), "", "cannot read: not a file but a folder, a pipe or a device");
  }
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ > kLargestScanFile) {
    throw DamagedScan(path.string(), "byte " + std::to_string(kLargestScanFile),
                      "the file is larger than 1 GiB, which no single scan is", "split it, or leave it out");
  }
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
  // A number and the blank behind it take two bytes: what promises more is cut off, and no size below can wrap.
  const std::size_t most = bytes.size() / 2 + 1;
  const bool too_many = columns > 0 && rows > most / columns;
  const std::size_t wanted = too_many ? std::numeric_limits<std::size_t>::max() : rows * columns;
  std::vector<double> values;
  values.reserve(std::min(wanted, most));
  const char* at = bytes.data();
  const char* const end = at + bytes.size();
  std::size_t line = first_line;
  while (values.size() < wanted) {
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

namespace {

/// Columns as stated, else as the values show, else as the name suggests.
PointFile read_bin_file(std::span<const char> bytes, const std::string& name, const std::string& file,
                        const LogOptions& options) {
  const std::size_t usual = name.ends_with(".pcd.bin") ? 5 : 4;
  if (options.bin_columns > 0) {
    return internal::read_bin(bytes, options.bin_columns, file, options);
  }
  const std::size_t shown = internal::columns_shown_by(bytes).value_or(usual);
  const bool fits = bytes.size() % (shown * sizeof(float)) == 0;
  if (shown != usual && fits) {
    log(Severity::kDebug, file + ": read with " + std::to_string(shown) + " values a point, as they show");
  }
  return internal::read_bin(bytes, fits ? shown : usual, file, options);
}

/// A cloud whose points are mostly out of reach was written in other units or in another frame. Throws DamagedScan.
void require_sense(const PointFile& points, const std::string& file, const LogOptions& options) {
  const DroppedPoints& dropped = points.dropped;
  if (dropped.absurd <= points.cloud.size()) {
    return;
  }
  char range[160];
  std::snprintf(range, sizeof range, " of %zu points are farther than %g m (option log.max_range_m): %.0f to %.0f away",
                dropped.absurd + points.cloud.size(), options.max_range_m, dropped.nearest_absurd_m,
                dropped.farthest_absurd_m);
  const bool one_place = dropped.farthest_absurd_m - dropped.nearest_absurd_m < 0.5 * dropped.nearest_absurd_m;
  throw DamagedScan(file, "", std::to_string(dropped.absurd) + range,
                    one_place
                        ? "they lie together far from the origin, as in coordinates of a map (UTM): scans must be "
                          "in the frame of the sensor"
                        : "the unit may be millimetres, where metres are needed, or the records have another "
                          "layout (.bin: see log.bin_columns)");
}

PointFile read_by_kind(const std::filesystem::path& path, const LogOptions& options) {
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
    return read_bin_file(content.bytes(), name, file, options);
  }
  throw DamagedScan(file, "", "not a point file", "known are .bin, .pcd and .ply");
}

}  // namespace

PointFile read_point_file(const std::filesystem::path& path, const LogOptions& options) {
  PointFile points = read_by_kind(path, options);
  require_sense(points, path.string(), options);
  return points;
}

}  // namespace loopmark::io
