// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/log_formats.hpp"

#include <algorithm>

namespace loopmark::io {

namespace internal {

std::vector<DriveLogFormat> all_log_formats();  // made by the build

}  // namespace internal

const std::vector<DriveLogFormat>& log_formats() {
  static const std::vector<DriveLogFormat> table = [] {
    std::vector<DriveLogFormat> all = internal::all_log_formats();
    std::sort(all.begin(), all.end(), [](const DriveLogFormat& a, const DriveLogFormat& b) {
      return std::tie(a.order, a.name) < std::tie(b.order, b.name);
    });
    return all;
  }();
  return table;
}

std::string log_formats_text() {
  std::string text;
  for (const DriveLogFormat& format : log_formats()) {
    std::string name = format.name;
    name.resize(std::max<std::size_t>(name.size() + 1, 16), ' ');
    text += "  " + name + format.layout + "\n";
  }
  return text;
}

}  // namespace loopmark::io
