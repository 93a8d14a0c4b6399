// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "npy.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <regex>

#include "loopmark/core/error.hpp"

namespace loopmark::features::internal {
namespace {

struct Header {
  char kind = 'f';
  std::size_t item_bytes = 4;
  bool fortran = false;
  Eigen::Index rows = 0;
  Eigen::Index columns = 0;
  std::size_t data = 0;  ///< where the numbers start
};

/// Errors of one array of one file.
struct Complaint {
  const std::string& file;
  const std::string& place;
  [[noreturn]] void operator()(const std::string& problem, const std::string& remedy = "") const {
    throw InputError(file, place, problem, remedy);
  }
};

std::string_view header_text(std::string_view bytes, const Complaint& fail, std::size_t& data) {
  if (bytes.size() < 12 || bytes.substr(0, 6) != std::string_view("\x93NUMPY", 6)) {
    fail("not a NumPy array", "write it with numpy.save");
  }
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
  const bool short_length = byte(6) == 1;
  const std::size_t start = short_length ? 10 : 12;
  const std::size_t length =
      short_length ? byte(8) + 256 * byte(9) : byte(8) + 256 * (byte(9) + 256 * (byte(10) + 256 * byte(11)));
  if (length > bytes.size() - start) {
    fail("the header is cut off");
  }
  data = start + length;
  return bytes.substr(start, length);
}

Header parse_header(std::string_view bytes, const Complaint& fail) {
  static const std::regex kType(R"('descr':\s*'([<>|=])([a-zA-Z])(\d{1,2})')");
  static const std::regex kFortran(R"('fortran_order':\s*True)");
  static const std::regex kShape(R"('shape':\s*\((\d{1,12}),\s*(\d{1,6})\))");
  Header header;
  const std::string text(header_text(bytes, fail, header.data));
  std::smatch found;
  if (!std::regex_search(text, found, kType)) {
    fail("the type of the array is not a plain number", "save it as float32");
  }
  header.kind = found[2].str()[0];
  header.item_bytes = std::stoul(found[3].str());
  if (found[1].str() == ">") {
    fail("the numbers are big-endian", "save it as little-endian float32");
  }
  header.fortran = std::regex_search(text, kFortran);
  if (!std::regex_search(text, found, kShape)) {
    fail("the array does not have two dimensions", "save one row a point");
  }
  header.rows = std::stoll(found[1].str());
  header.columns = std::stoll(found[2].str());
  return header;
}

template <class Number>
void convert(std::string_view bytes, const Header& header, search::DescriptorMatrix& out) {
  for (Eigen::Index r = 0; r < header.rows; ++r) {
    for (Eigen::Index c = 0; c < header.columns; ++c) {
      const auto k = static_cast<std::size_t>(header.fortran ? c * header.rows + r : r * header.columns + c);
      Number value;
      std::memcpy(static_cast<void*>(&value), bytes.data() + header.data + k * sizeof value, sizeof value);
      out(r, c) = static_cast<float>(value);
    }
  }
}

void require_finite(const search::DescriptorMatrix& numbers, const Complaint& fail) {
  for (Eigen::Index r = 0; r < numbers.rows(); ++r) {
    if (!numbers.row(r).allFinite()) {
      fail("row " + std::to_string(r) + " holds a number that is not finite",
           "leave out the points that could not be described");
    }
  }
}

}  // namespace

search::DescriptorMatrix parse_npy(std::string_view bytes, const std::string& file, const std::string& place) {
  const Complaint fail{file, place};
  const Header header = parse_header(bytes, fail);
  const auto available = (bytes.size() - header.data) / std::max<std::size_t>(1, header.item_bytes);
  const auto wanted = static_cast<std::size_t>(header.rows) * static_cast<std::size_t>(header.columns);
  if (wanted > available) {
    fail("the array is cut off: " + std::to_string(available) + " of " + std::to_string(wanted) + " numbers");
  }
  search::DescriptorMatrix out(header.rows, header.columns);
  const std::string type = std::string(1, header.kind) + std::to_string(header.item_bytes);
  if (type == "f4") {
    convert<float>(bytes, header, out);
  } else if (type == "f8") {
    convert<double>(bytes, header, out);
  } else if (type == "f2") {
    convert<Eigen::half>(bytes, header, out);
  } else if (type == "i4") {
    convert<std::int32_t>(bytes, header, out);
  } else if (type == "i8") {
    convert<std::int64_t>(bytes, header, out);
  } else if (type == "u1") {
    convert<std::uint8_t>(bytes, header, out);
  } else if (type == "i1") {
    convert<std::int8_t>(bytes, header, out);
  } else {
    fail("numbers of type " + type + " are not known", "save it as float32");
  }
  require_finite(out, fail);
  return out;
}

bool is_int8(std::string_view npy) {
  const std::string nowhere;
  const Complaint fail{nowhere, nowhere};
  const Header header = parse_header(npy, fail);
  return header.kind == 'i' && header.item_bytes == 1;
}

}  // namespace loopmark::features::internal
