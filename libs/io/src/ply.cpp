// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// PLY polygon files, of which only the vertices are read.
#include <vector>

#include "loopmark/text/text.hpp"
#include "point_columns.hpp"
#include "point_formats.hpp"

namespace loopmark::io::internal {
namespace {

struct Property {
  std::string name;
  NumberType type = NumberType::kFloat32;
};

struct Header {
  std::string format;
  std::size_t points = 0;
  std::vector<Property> properties;  ///< of the vertices
  std::size_t size = 0;
  std::size_t lines = 0;
};

class HeaderReader {
 public:
  HeaderReader(std::span<const char> bytes, const std::string& file) : text_(bytes.data(), bytes.size()), file_(file) {}

  Header read() {
    if (!text_.starts_with("ply")) {
      fail("the file does not start with 'ply'");
    }
    while (!ended_) {
      const std::size_t end = text_.find('\n', header_.size);
      if (end == std::string_view::npos || header_.lines > 1000) {
        fail("the header has no end_header line: truncated");
      }
      std::string_view line = text_.substr(header_.size, end - header_.size);
      header_.size = end + 1;
      ++header_.lines;
      if (!line.empty() && line.back() == '\r') {
        line.remove_suffix(1);
      }
      take(text::split_words(line));
    }
    if (header_.points == 0) {
      fail("the header promises no vertices");
    }
    return header_;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw DamagedScan(file_, "line " + std::to_string(header_.lines), problem);
  }

  NumberType type_of(std::string_view word) const {
    if (word == "float" || word == "float32") return NumberType::kFloat32;
    if (word == "double" || word == "float64") return NumberType::kFloat64;
    if (word == "uchar" || word == "uint8") return NumberType::kUint8;
    if (word == "char" || word == "int8") return NumberType::kInt8;
    if (word == "ushort" || word == "uint16") return NumberType::kUint16;
    if (word == "short" || word == "int16") return NumberType::kInt16;
    if (word == "uint" || word == "uint32") return NumberType::kUint32;
    if (word == "int" || word == "int32") return NumberType::kInt32;
    fail("the vertices have a property of the type '" + std::string(word) + "', which cannot be read");
  }

  void take(const std::vector<std::string_view>& words) {
    if (words.empty()) {
      return;
    }
    if (words[0] == "end_header") {
      ended_ = true;
    } else if (words[0] == "format" && words.size() > 1) {
      header_.format = std::string(words[1]);
    } else if (words[0] == "element" && words.size() > 2) {
      take_element(words[1], words[2]);
    } else if (words[0] == "property" && words.size() > 2 && in_vertices_) {
      header_.properties.push_back({std::string(words.back()), type_of(words[1])});
    }
  }

  void take_element(std::string_view name, std::string_view count) {
    in_vertices_ = name == "vertex";
    const auto number = text::parse_whole(count);
    if (!number || *number > (1ULL << 32U)) {
      fail("'" + std::string(count) + "' is no sensible number");
    }
    if (in_vertices_) {
      header_.points = static_cast<std::size_t>(*number);
    } else if (header_.points == 0 && *number > 0) {
      fail("the vertices do not come first");
    }
  }

  std::string_view text_;
  const std::string& file_;
  Header header_;
  bool in_vertices_ = false;
  bool ended_ = false;
};

PointColumns columns_of(const Header& header, const char* data, std::size_t stride, bool as_float64) {
  PointColumns columns;
  columns.count = header.points;
  std::size_t before = 0;
  for (const Property& property : header.properties) {
    const NumberType type = as_float64 ? NumberType::kFloat64 : property.type;
    Column* column = column_for_field(columns, property.name);
    if (column != nullptr && column->empty()) {
      *column = {data + before, stride, type};
    }
    before += size_of(type);
  }
  return columns;
}

}  // namespace

PointFile read_ply(std::span<const char> bytes, const std::string& file, const LogOptions& options) {
  const Header header = HeaderReader(bytes, file).read();
  const std::span<const char> body = bytes.subspan(header.size);
  std::vector<double> table;
  PointColumns columns;
  if (header.format == "ascii") {
    const std::size_t width = header.properties.size();
    table = read_ascii_table(body, header.points, width, file, header.lines + 1);
    columns = columns_of(header, reinterpret_cast<const char*>(table.data()), width * sizeof(double), true);
  } else if (header.format == "binary_little_endian") {
    std::size_t stride = 0;
    for (const Property& property : header.properties) {
      stride += size_of(property.type);
    }
    if (body.size() < stride * header.points) {
      throw_truncated(file, bytes.size(), header.size + stride * header.points);
    }
    columns = columns_of(header, body.data(), stride, false);
  } else {
    throw DamagedScan(file, "header", "the format '" + header.format + "' cannot be read",
                      "convert it to ascii or binary_little_endian");
  }
  require_coordinates(columns, file);
  return decode_points(columns, options);
}

}  // namespace loopmark::io::internal
