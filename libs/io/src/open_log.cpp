// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string_view>

#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/log_formats.hpp"

namespace loopmark::io {
namespace fs = std::filesystem;
namespace {

bool is_called(const DriveLogFormat& format, const std::string& name) {
  return name == format.name || std::find(format.aliases.begin(), format.aliases.end(), name) != format.aliases.end();
}

std::string known_formats() {
  std::string names = "auto";
  for (const DriveLogFormat& format : log_formats()) {
    names += ", " + format.name;
    for (const std::string& alias : format.aliases) {
      names += ", " + alias;
    }
  }
  return names;
}

void require_there(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    throw InputError(path.string(), "", "no such file or folder", "give the folder or file of a drive log");
  }
  if (fs::is_directory(path, error) && fs::is_empty(path, error)) {
    throw InputError(path.string(), "", "the folder is empty");
  }
}

}  // namespace

void check(const LogOptions& options) {
  require_option(std::isfinite(options.rate_hz) && options.rate_hz > 0.0, "rate_hz", "must be above 0");
  require_option(options.max_range_m > 0.0, "max_range_m", "must be above 0");
  require_option(options.bin_columns == 0 || (options.bin_columns >= 3 && options.bin_columns <= 6), "bin_columns",
                 "must be 0 (guess) or 3 to 6");
  bool known = options.format == "auto";
  for (const DriveLogFormat& format : log_formats()) {
    known = known || is_called(format, options.format);
  }
  require_option(known, "format", "'" + options.format + "' is none of " + known_formats());
}

std::unique_ptr<DriveLog> open_log(const fs::path& path, const LogOptions& options) {
  check(options);
  require_there(path);
  for (const DriveLogFormat& format : log_formats()) {
    if (options.format != "auto" && !is_called(format, options.format)) {
      continue;
    }
    if (std::unique_ptr<DriveLog> opened = format.open(path, options)) {
      return opened;
    }
  }
  throw InputError(path.string(), "", "no drive log found here", "a drive log is one of these:\n" + log_formats_text());
}

}  // namespace loopmark::io
