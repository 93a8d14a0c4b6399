// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Columns of numbers inside a page: compressed (zlib), as base64, in an element that the page's script reads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace loopmark::web_page {

/// What helps a column compress; the page undoes it.
enum class Filter {
  kPlanes,  ///< first bytes of all numbers, then the second ones, ...
  kDelta    ///< differences of neighbours (zigzag), then planes; whole numbers only
};

/// The element of one column, to be put into a Document. Names hold letters, digits and dots.
std::string block(const std::string& name, const std::vector<float>& values);
std::string block(const std::string& name, const std::vector<double>& values);
std::string block(const std::string& name, const std::vector<std::uint8_t>& values);
std::string block(const std::string& name, const std::vector<std::uint16_t>& values, Filter filter = Filter::kDelta);
std::string block(const std::string& name, const std::vector<std::int16_t>& values, Filter filter = Filter::kDelta);
std::string block(const std::string& name, const std::vector<std::uint32_t>& values, Filter filter = Filter::kDelta);

}  // namespace loopmark::web_page
