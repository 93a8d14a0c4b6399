// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/web_page/block.hpp"

#include <zlib.h>

#include <stdexcept>
#include <type_traits>

#include "loopmark/web_page/base64.hpp"

namespace loopmark::web_page {
namespace {

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(size, '\0');
  const auto* from = reinterpret_cast<const Bytef*>(bytes.data());
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, from, static_cast<uLong>(bytes.size()),
                Z_DEFAULT_COMPRESSION) != Z_OK) {
    throw std::runtime_error("zlib could not compress a column of a page");
  }
  result.resize(size);
  return result;
}

/// Differences wrap round; a small one of either sign becomes a small number without sign.
template <class T>
std::vector<T> differences(const std::vector<T>& values) {
  using Unsigned = std::make_unsigned_t<T>;
  std::vector<T> result(values.size());
  Unsigned before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto difference = static_cast<Unsigned>(static_cast<Unsigned>(values[i]) - before);
    const bool negative = (difference >> (8 * sizeof(T) - 1)) != 0;
    const auto doubled = static_cast<Unsigned>(difference << 1);
    result[i] = static_cast<T>(negative ? static_cast<Unsigned>(~doubled) : doubled);
    before = static_cast<Unsigned>(values[i]);
  }
  return result;
}

template <class T>
std::string planes(const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const char*>(values.data());
  std::string result;
  result.reserve(values.size() * sizeof(T));
  for (std::size_t plane = 0; plane < sizeof(T); ++plane) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      result += bytes[i * sizeof(T) + plane];
    }
  }
  return result;
}

std::string element(const std::string& name, const std::string& type, const std::string& filter,
                    const std::string& bytes) {
  return "<script type=\"text/plain\" class=\"block\" data-name=\"" + name + "\" data-type=\"" + type +
         "\" data-filter=\"" + filter + "\">" + base64(compressed(bytes)) + "</script>\n";
}

template <class T>
std::string whole(const std::string& name, const std::string& type, const std::vector<T>& values, Filter filter) {
  return filter == Filter::kDelta ? element(name, type, "delta planes", planes(differences(values)))
                                  : element(name, type, "planes", planes(values));
}

}  // namespace

std::string block(const std::string& name, const std::vector<float>& values) {
  return element(name, "f32", "planes", planes(values));
}

std::string block(const std::string& name, const std::vector<double>& values) {
  return element(name, "f64", "planes", planes(values));
}

std::string block(const std::string& name, const std::vector<std::uint8_t>& values) {
  return element(name, "u8", "", std::string(values.begin(), values.end()));
}

std::string block(const std::string& name, const std::vector<std::uint16_t>& values, Filter filter) {
  return whole(name, "u16", values, filter);
}

std::string block(const std::string& name, const std::vector<std::int16_t>& values, Filter filter) {
  return whole(name, "i16", values, filter);
}

std::string block(const std::string& name, const std::vector<std::uint32_t>& values, Filter filter) {
  return whole(name, "u32", values, filter);
}

}  // namespace loopmark::web_page
