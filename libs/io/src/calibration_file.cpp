// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration_file.hpp"

#include <vector>

namespace loopmark::io::internal {
namespace fs = std::filesystem;
namespace {

constexpr const char* kBagMetadata = "metadata.yaml";  // of a ROS 2 bag, no sensor's

}  // namespace

fs::path find_calibration(const fs::path& log, const char* extension) {
  std::error_code error;
  const fs::path absolute = fs::absolute(log, error).lexically_normal();
  const fs::path name = absolute.has_filename() ? absolute.filename() : absolute.parent_path().filename();
  const fs::path folder = absolute.has_filename() ? absolute.parent_path() : absolute.parent_path().parent_path();
  std::vector<fs::path> found;
  for (const fs::path& place : {fs::is_directory(absolute, error) ? absolute : folder, folder}) {
    for (const std::string& stem : {name.stem().string(), std::string("calibration"), std::string("metadata")}) {
      if (stem + extension != kBagMetadata && fs::is_regular_file(place / (stem + extension), error)) {
        return place / (stem + extension);
      }
    }
    for (fs::directory_iterator it(place, error), end; !error && it != end; it.increment(error)) {
      if (it->path().extension() == extension && it->path().filename() != kBagMetadata) {
        found.push_back(it->path());
      }
    }
    if (found.size() == 1) {
      return found.front();
    }
    found.clear();
  }
  return {};
}

}  // namespace loopmark::io::internal
