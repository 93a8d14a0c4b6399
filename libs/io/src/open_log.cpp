// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <string_view>

#include "layouts.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io {
namespace fs = std::filesystem;
namespace {

struct Format {
  std::string_view name;
  internal::LogPointer (*open)(const fs::path& path, const LogOptions& options);
};

/// The most particular layouts first: the first that fits is taken.
constexpr std::array kFormats = {
    Format{"kitti-raw", internal::open_kitti_raw}, Format{"mulran", internal::open_mulran},
    Format{"apollo", internal::open_apollo},       Format{"folder", internal::open_folder},
    Format{"rawlog", internal::open_rawlog},
};

std::string known_formats() {
  std::string names = "auto, kitti-odometry";
  for (const Format& format : kFormats) {
    names += ", " + std::string(format.name);
  }
  return names;
}

bool wanted(const Format& format, const std::string& name) {
  return name == "auto" || name == format.name || (name == "kitti-odometry" && format.name == "folder");
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
  require_option(std::isfinite(options.rate_hz) && options.rate_hz > 0.0, "log.rate_hz", "must be above 0");
  require_option(options.max_range_m > 0.0, "log.max_range_m", "must be above 0");
  require_option(options.bin_columns == 0 || (options.bin_columns >= 3 && options.bin_columns <= 6), "log.bin_columns",
                 "must be 0 (guess) or 3 to 6");
  bool known = options.format == "auto" || options.format == "kitti-odometry";
  for (const Format& format : kFormats) {
    known = known || options.format == format.name;
  }
  require_option(known, "log.format", "'" + options.format + "' is none of " + known_formats());
}

std::unique_ptr<DriveLog> open_log(const fs::path& path, const LogOptions& options) {
  check(options);
  require_there(path);
  for (const Format& format : kFormats) {
    if (!wanted(format, options.format)) {
      continue;
    }
    if (internal::LogPointer opened = format.open(path, options)) {
      return opened;
    }
  }
  throw InputError(path.string(), "", "no drive log found here",
                   "looked for *.bin, *.pcd or *.ply in the folder, in velodyne/, velodyne_points/data/, Ouster/ and "
                   "pcds/, or in one other sub-folder, and for a .rawlog file");
}

}  // namespace loopmark::io
