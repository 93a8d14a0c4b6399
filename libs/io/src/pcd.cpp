// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// PCD (point cloud data) files, version 0.7 and earlier ones.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "loopmark/text/text.hpp"
#include "point_columns.hpp"
#include "point_formats.hpp"

namespace loopmark::io::internal {
namespace {

// What a header may promise. The product of all of them fits 64 bits, so that no size below can wrap.
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 32U;
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 16U;  // of one field; the largest known descriptor has 1980
constexpr std::uint64_t kMostBytes = 8;                         // of one value
constexpr std::size_t kMostFields = 1024;

struct Field {
  std::string name;
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;

  std::size_t bytes() const { return size * count; }
};

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0;
  std::string data;      ///< ascii, binary, binary_compressed
  std::size_t size = 0;  ///< bytes of the header
  std::size_t lines = 0;
  bool has_viewpoint = false;  ///< that is no identity

  std::size_t point_bytes() const {
    std::size_t sum = 0;
    for (const Field& field : fields) {
      sum += field.bytes();
    }
    return sum;
  }
};

/// Reads header lines and throws with their number.
class HeaderReader {
 public:
  HeaderReader(std::span<const char> bytes, const std::string& file) : text_(bytes.data(), bytes.size()), file_(file) {}

  Header read() {
    while (header_.data.empty()) {
      const std::size_t end = text_.find('\n', header_.size);
      if (end == std::string_view::npos || header_.lines > 100) {
        fail("the header has no DATA line: not a PCD file, or truncated");
      }
      std::string_view line = text_.substr(header_.size, end - header_.size);
      header_.size = end + 1;
      ++header_.lines;
      if (!line.empty() && line.back() == '\r') {
        line.remove_suffix(1);
      }
      take(text::split_words(line));
    }
    finish();
    return header_;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw DamagedScan(file_, "line " + std::to_string(header_.lines), problem);
  }

  std::size_t whole(std::string_view word, std::uint64_t most) const {
    const auto value = text::parse_whole(word);
    if (!value || *value > most) {
      fail("'" + std::string(word) + "' is no sensible number");
    }
    return static_cast<std::size_t>(*value);
  }

  template <class Set>
  void each_field(const std::vector<std::string_view>& words, const Set& set) {
    if (words.size() != header_.fields.size() + 1) {
      fail(std::string(words.front()) + " has another number of entries than FIELDS");
    }
    for (std::size_t i = 1; i < words.size(); ++i) {
      set(header_.fields[i - 1], words[i]);
    }
  }

  /// tx ty tz qw qx qy qz of a VIEWPOINT line: whether they are no identity.
  static bool moves(const std::vector<std::string_view>& words) {
    for (std::size_t i = 1; i < words.size(); ++i) {
      const double still = i == 4 ? 1.0 : 0.0;
      const std::optional<double> value = text::parse_number(words[i]);
      if (value && std::abs((i == 4 ? std::abs(*value) : *value) - still) > 1e-6) {
        return true;
      }
    }
    return false;
  }

  void take(const std::vector<std::string_view>& words) {
    if (words.size() < 2 || words.front().front() == '#') {
      return;
    }
    const std::string_view key = words.front();
    if (key == "FIELDS" || key == "COLUMNS") {
      for (std::size_t i = 1; i < words.size(); ++i) {
        header_.fields.push_back({std::string(words[i])});
      }
      if (header_.fields.size() > kMostFields) {
        fail("more than " + std::to_string(kMostFields) + " fields");
      }
    } else if (key == "SIZE") {
      each_field(words, [this](Field& field, std::string_view word) { field.size = whole(word, kMostBytes); });
    } else if (key == "TYPE") {
      each_field(words, [](Field& field, std::string_view word) { field.type = word.front(); });
    } else if (key == "COUNT") {
      each_field(words, [this](Field& field, std::string_view word) { field.count = whole(word, kMostValues); });
    } else if (key == "WIDTH") {
      width_ = whole(words[1], kMostPoints);
    } else if (key == "HEIGHT") {
      height_ = whole(words[1], kMostPoints);
    } else if (key == "POINTS") {
      header_.points = whole(words[1], kMostPoints);
      points_said_ = true;
    } else if (key == "VIEWPOINT") {
      header_.has_viewpoint = moves(words);
    } else if (key == "DATA") {
      header_.data = text::lower_case(words[1]);
    }
  }

  void finish() {
    if (!points_said_) {
      if (height_ > 0 && width_ > kMostPoints / height_) {
        fail("WIDTH and HEIGHT promise more than " + std::to_string(kMostPoints) + " points");
      }
      header_.points = width_ * height_;
    }
    if (header_.fields.empty()) {
      fail("the header has no FIELDS line");
    }
    if (header_.points == 0) {
      fail("the header promises no points");
    }
  }

  std::string_view text_;
  const std::string& file_;
  Header header_;
  std::size_t width_ = 0;
  std::size_t height_ = 1;
  bool points_said_ = false;
};

NumberType number_type(const Field& field, const std::string& file) {
  const std::string code = field.type + std::to_string(field.size);
  if (code == "F4") return NumberType::kFloat32;
  if (code == "F8") return NumberType::kFloat64;
  if (code == "U1") return NumberType::kUint8;
  if (code == "U2") return NumberType::kUint16;
  if (code == "U4") return NumberType::kUint32;
  if (code == "U8") return NumberType::kUint64;
  if (code == "I1") return NumberType::kInt8;
  if (code == "I2") return NumberType::kInt16;
  if (code == "I4") return NumberType::kInt32;
  if (code == "I8") return NumberType::kInt64;
  throw DamagedScan(file, "header", "field " + field.name + " has the unknown type " + code);
}

/// Places each known field. `offset(field, bytes before it in a point)` and `stride(field)` say where its
/// numbers lie.
template <class Place>
PointColumns place_columns(const Header& header, const std::string& file, const Place& place) {
  PointColumns columns;
  columns.count = header.points;
  std::size_t before = 0;
  for (const Field& field : header.fields) {
    Column* column = column_for_field(columns, field.name);
    if (column != nullptr && column->empty() && field.count == 1) {
      *column = place(field, before, number_type(field, file));
    }
    before += field.bytes();
  }
  require_coordinates(columns, file);
  return columns;
}

PointFile decode_binary(const Header& header, std::span<const char> body, const std::string& file,
                        const LogOptions& options) {
  const std::size_t stride = header.point_bytes();
  if (body.size() < stride * header.points) {
    throw_truncated(file, header.size + body.size(), header.size + stride * header.points);
  }
  const auto place = [&](const Field&, std::size_t before, NumberType type) {
    return Column{body.data() + before, stride, type};
  };
  return decode_points(place_columns(header, file, place), options);
}

PointFile decode_compressed(const Header& header, std::span<const char> body, const std::string& file,
                            const LogOptions& options) {
  std::uint32_t sizes[2] = {0, 0};  // compressed, plain
  if (body.size() < sizeof sizes) {
    throw_truncated(file, header.size + body.size(), header.size + sizeof sizes);
  }
  std::memcpy(sizes, body.data(), sizeof sizes);
  if (body.size() < sizeof sizes + sizes[0]) {
    throw_truncated(file, header.size + body.size(), header.size + sizeof sizes + sizes[0]);
  }
  // LZF writes at most 264 bytes for 3.
  if (sizes[1] != header.point_bytes() * header.points || sizes[1] / 88 > sizes[0]) {
    throw DamagedScan(file, "byte " + std::to_string(header.size + 4), "the compressed size does not fit the header");
  }
  const std::unique_ptr<char[]> plain(new char[sizes[1]]);
  if (!lzf_decompress(body.subspan(sizeof sizes, sizes[0]), {plain.get(), sizes[1]})) {
    throw DamagedScan(file, "byte " + std::to_string(header.size + sizeof sizes), "the compressed data is damaged");
  }
  const auto place = [&](const Field& field, std::size_t before, NumberType type) {
    return Column{plain.get() + before * header.points, field.size, type};  // field after field
  };
  return decode_points(place_columns(header, file, place), options);
}

PointFile decode_ascii(const Header& header, std::span<const char> body, const std::string& file,
                       const LogOptions& options) {
  std::size_t width = 0;
  for (const Field& field : header.fields) {
    width += field.count;
  }
  const std::vector<double> values = read_ascii_table(body, header.points, width, file, header.lines + 1);
  PointColumns columns;
  columns.count = header.points;
  std::size_t before = 0;
  for (const Field& field : header.fields) {
    Column* column = column_for_field(columns, field.name);
    if (column != nullptr && column->empty() && field.count == 1) {
      *column = {reinterpret_cast<const char*>(values.data() + before), width * sizeof(double), NumberType::kFloat64};
    }
    before += field.count;
  }
  require_coordinates(columns, file);
  return decode_points(columns, options);
}

}  // namespace

PointFile read_pcd(std::span<const char> bytes, const std::string& file, const LogOptions& options) {
  const Header header = HeaderReader(bytes, file).read();
  const std::span<const char> body = bytes.subspan(header.size);
  const auto decode = header.data == "binary"              ? decode_binary
                      : header.data == "binary_compressed" ? decode_compressed
                      : header.data == "ascii"             ? decode_ascii
                                                           : nullptr;
  if (decode == nullptr) {
    throw DamagedScan(file, "line " + std::to_string(header.lines), "unknown DATA '" + header.data + "'");
  }
  PointFile points = decode(header, body, file, options);
  points.has_viewpoint = header.has_viewpoint;
  return points;
}

}  // namespace loopmark::io::internal
