// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The formats of drive logs. One more is one more source in src/, called format_NAME.cpp, with one function
/// `DriveLogFormat format_NAME()`: the build makes the table of them, and help, doctor and options read it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "loopmark/io/drive_log.hpp"

namespace loopmark::io {

struct DriveLogFormat {
  std::string name;    ///< as log.format takes it
  std::string layout;  ///< what it looks like on disk, one line for people
  int order = 0;       ///< in which the formats are tried: particular layouts before those that fit much
  /// Opens a log; nullptr when what is there is not of this format. Throws InputError when it is, but broken.
  std::function<std::unique_ptr<DriveLog>(const std::filesystem::path&, const LogOptions&)> open;
  /// Other names that log.format takes for it.
  std::vector<std::string> aliases = {};
};

/// All formats in the order in which they are tried.
const std::vector<DriveLogFormat>& log_formats();

/// A line for each format: its name and its layout.
std::string log_formats_text();

}  // namespace loopmark::io
