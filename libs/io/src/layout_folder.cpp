// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "layout_parts.hpp"
#include "layouts.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io::internal {
namespace fs = std::filesystem;
namespace {

/// Where the point files lie, and where what belongs to them lies.
struct Place {
  fs::path base;
  std::vector<fs::path> files;
};

Place find_files(const fs::path& path) {
  if (auto files = list_point_files(path / "velodyne"); !files.empty()) {
    return {path, std::move(files)};
  }
  if (auto files = list_point_files(path); !files.empty()) {
    const fs::path folder = path.has_filename() ? path : path.parent_path();
    return {folder.filename() == "velodyne" ? folder.parent_path() : folder, std::move(files)};
  }
  Place place;
  for (const fs::path& folder : list_folders(path)) {
    auto files = list_point_files(folder);
    if (!files.empty() && !place.files.empty()) {
      return {};  // several folders with scans: which one is meant?
    }
    if (!files.empty()) {
      place = {path, std::move(files)};
    }
  }
  return place;
}

/// T_camera_lidar of KITTI's calib.txt (line "Tr: ..."); nothing without the file. Throws InputError.
std::optional<Pose> read_calibration(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return std::nullopt;
  }
  const std::string text = storage::read_file(file);
  std::size_t number = 0;
  for (const std::string_view line : text::split_lines(text)) {
    ++number;
    const auto words = text::split_words(line);
    if (words.empty() || (words[0] != "Tr:" && words[0] != "Tr_velo_to_cam:" && words[0] != "Tr_velo_cam:")) {
      continue;
    }
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    for (std::size_t k = 0; k < 12; ++k) {
      const auto value = k + 1 < words.size() ? text::parse_number(words[k + 1]) : std::nullopt;
      if (!value) {
        throw InputError(file.string(), std::to_string(number), "Tr needs 12 numbers");
      }
      matrix(static_cast<int>(k / 4), static_cast<int>(k % 4)) = *value;
    }
    try {
      return rigid_from_matrix(matrix, 1e-2);
    } catch (const std::invalid_argument& problem) {
      throw InputError(file.string(), std::to_string(number), problem.what());
    }
  }
  throw InputError(file.string(), "", "no line 'Tr:' with the motion from LiDAR to camera",
                   "complete the file, or move it away when poses.txt holds LiDAR poses");
}

/// poses.txt beside the scans, or KITTI's poses/NN.txt beside sequences/.
fs::path poses_file(const fs::path& base) {
  const fs::path beside = base / "poses.txt";
  std::error_code error;
  const fs::path sequences = fs::absolute(base, error).parent_path();
  const fs::path central = sequences.parent_path() / "poses" / (base.filename().string() + ".txt");
  return !fs::exists(beside, error) && sequences.filename() == "sequences" ? central : beside;
}

}  // namespace

LogPointer open_folder(const fs::path& path, const LogOptions& options) {
  Place place = find_files(path);
  if (place.files.empty()) {
    return nullptr;
  }
  const fs::path base = place.base;
  FileLogParts parts = parts_of_files(std::move(place.files), base, options);
  const std::string kind = point_file_kind(parts.files.front());
  std::error_code error;
  const bool kitti = kind == "bin" && (fs::exists(base / "times.txt", error) || fs::exists(base / "calib.txt", error) ||
                                       fs::exists(base / "poses.txt", error));
  parts.info.format = kitti ? "kitti-odometry" : "folder-" + kind;
  parts.info.path = path;
  take_stamps(parts, base / "times.txt");
  take_truth(parts, poses_file(base), read_calibration(base / "calib.txt"));
  if (fs::is_regular_file(base / "calib.txt", error)) {
    parts.info.companions.push_back(base / "calib.txt");
  }
  return std::make_unique<FileLog>(std::move(parts));
}

}  // namespace loopmark::io::internal
