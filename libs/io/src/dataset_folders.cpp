// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Data sets whose drives are folders: KITTI odometry, Apollo-SouthBay, MulRan, any folder of logs.
#include <algorithm>
#include <array>
#include <map>

#include "dataset_layouts.hpp"
#include "layout_parts.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io {
namespace fs = std::filesystem;
namespace {

using Parts = Dataset::Parts;

/// The drives of Apollo-SouthBay in the order in which the published sets number them.
constexpr std::array kApolloDrives = {
    "MapData/HighWay237/2018-10-05",
    "MapData/SunnyvaleBigloop/Caspian_and_Geneva/2017-12-13",
    "MapData/SunnyvaleBigloop/Borrgas/2017-12-13",
    "MapData/SunnyvaleBigloop/Java/2017-12-13",
    "MapData/SunnyvaleBigloop/Mathilda_Moffet/2017-12-28",
    "MapData/SunnyvaleBigloop/Crossman/2017-12-13",
    "MapData/SunnyvaleBigloop/Mathilda_Carribean/2017-12-14",
    "MapData/SunnyvaleBigloop/Bordeaux/2017-12-13",
    "MapData/MathildaAVE/2018-09-25",
    "MapData/SanJoseDowntown/2018-10-02",
    "MapData/BaylandsToSeafood/2018-09-26",
    "MapData/ColumbiaPark/2018-09-21/2",
    "MapData/ColumbiaPark/2018-09-21/4",
    "MapData/ColumbiaPark/2018-09-21/1",
    "MapData/ColumbiaPark/2018-09-21/3",
    "TrainData/HighWay237/2018-10-12",
    "TrainData/MathildaAVE/2018-10-04",
    "TrainData/SanJoseDowntown/2018-10-11",
    "TrainData/BaylandsToSeafood/2018-10-05",
    "TrainData/ColumbiaPark/2018-10-03",
    "TestData/HighWay237/2018-10-12",
    "TestData/SunnyvaleBigloop/2018-10-03",
    "TestData/MathildaAVE/2018-10-12",
    "TestData/SanJoseDowntown/2018-10-11/2",
    "TestData/SanJoseDowntown/2018-10-11/1",
    "TestData/BaylandsToSeafood/2018-10-12",
    "TestData/ColumbiaPark/2018-10-11",
};

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

Parts parts_of(std::string layout, std::string description, const fs::path& root, const DatasetOptions& options) {
  Parts parts;
  parts.layout = std::move(layout);
  parts.description = std::move(description);
  parts.root = root;
  parts.open = [log = options.log](const SessionInfo& session) { return open_log(session.path, log); };
  return parts;
}

/// Where the drives of Apollo-SouthBay's archives lie: as on the list, or each archive unpacked in a folder of its own
/// (AREA/Apollo-SourthBay/TestData/AREA/...).
fs::path apollo_drive(const fs::path& root, const std::string& drive) {
  for (const fs::path& base : {root, root / "Apollo-SouthBay", root / "Apollo-SourthBay"}) {
    if (is_folder(base / drive)) {
      return base / drive;
    }
  }
  for (const fs::path& area : internal::list_folders(root)) {
    for (const char* const below : {"", "Apollo-SouthBay", "Apollo-SourthBay"}) {
      if (is_folder(area / below / drive)) {
        return area / below / drive;
      }
    }
  }
  return root / drive;
}

std::vector<fs::path> folders_and_rawlogs(const fs::path& root) {
  std::vector<fs::path> places = internal::list_folders(root);
  std::error_code error;
  for (fs::directory_iterator it(root, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".rawlog") {
      places.push_back(it->path());
    }
  }
  std::sort(places.begin(), places.end(), [](const fs::path& a, const fs::path& b) {
    return text::natural_less(a.filename().string(), b.filename().string());
  });
  return places;
}

/// True when a drive log can be opened here; damaged ones count, so that their problem is told when they are used.
bool looks_like_log(const fs::path& path, const LogOptions& options) {
  if (path.extension() == ".rawlog") {
    return true;  // opening would read it whole
  }
  try {
    return open_log(path, options) != nullptr;
  } catch (const InputError& error) {
    return std::string(error.what()).find("no drive log found") == std::string::npos &&
           !internal::list_point_files(path / "velodyne").empty();
  }
}

}  // namespace

std::optional<Parts> find_kitti_odometry(const fs::path& root, const DatasetOptions& options) {
  for (const fs::path& folder : {root / "sequences", root / "dataset" / "sequences", root}) {
    Parts parts = parts_of("kitti-odometry",
                           "KITTI odometry: clouds in the frame of the Velodyne, motion-compensated, 10 Hz, frames "
                           "from 0, session = sequence",
                           root, options);
    for (const fs::path& drive : internal::list_folders(folder)) {
      const std::string name = drive.filename().string();
      if (const auto number = text::parse_whole(name); number && name.size() == 2 && is_folder(drive / "velodyne")) {
        parts.sessions.push_back({static_cast<int>(*number), name, drive, true});
      }
    }
    if (!parts.sessions.empty()) {
      return parts;
    }
  }
  return std::nullopt;
}

std::optional<Parts> find_kitti_raw(const fs::path& root, const DatasetOptions& options) {
  Parts parts =
      parts_of("kitti-raw",
               "KITTI raw: clouds in the frame of the Velodyne, not motion-compensated, 10 Hz, frames from 0, "
               "sessions in order of the drives' names",
               root, options);
  std::vector<fs::path> places = internal::list_folders(root);  // the drives, or the dates with the drives
  for (const fs::path& date : internal::list_folders(root)) {
    const auto drives = internal::list_folders(date);
    places.insert(places.end(), drives.begin(), drives.end());
  }
  for (const fs::path& drive : places) {
    if (is_folder(drive / "velodyne_points")) {
      parts.sessions.push_back({static_cast<int>(parts.sessions.size()), drive.filename().string(), drive, true});
    }
  }
  return parts.sessions.empty() ? std::nullopt : std::optional(std::move(parts));
}

std::optional<Parts> find_apollo_southbay(const fs::path& root, const DatasetOptions& options) {
  Parts parts = parts_of("apollo-southbay",
                         "Apollo-SouthBay: clouds in the frame of the HDL-64E, motion-compensated, 10 Hz, frames from "
                         "1, sessions 0 to 26 in the order of the published sets (test: 20 to 26)",
                         root, options);
  bool any = false;
  for (std::size_t i = 0; i < kApolloDrives.size(); ++i) {
    const fs::path drive = apollo_drive(root, kApolloDrives[i]);
    const bool present = is_folder(drive / "pcds");
    any = any || present;
    parts.sessions.push_back({static_cast<int>(i), kApolloDrives[i], drive, present});
  }
  return any ? std::optional(std::move(parts)) : std::nullopt;
}

std::optional<Parts> find_mulran(const fs::path& root, const DatasetOptions& options) {
  Parts parts = parts_of("mulran",
                         "MulRan: clouds in the frame of the Ouster, 10 Hz, frames from 0 in order of time, sessions "
                         "in order of the drives' names",
                         root, options);
  for (const fs::path& drive : internal::list_folders(root)) {
    if (is_folder(drive / "Ouster") || is_folder(drive / "sensor_data" / "Ouster")) {
      parts.sessions.push_back({static_cast<int>(parts.sessions.size()), drive.filename().string(), drive, true});
    }
  }
  return parts.sessions.empty() ? std::nullopt : std::optional(std::move(parts));
}

std::optional<Parts> find_logs(const fs::path& root, const DatasetOptions& options) {
  std::error_code error;
  if (fs::exists(root / "sessions.txt", error)) {
    return logs_of_sessions_file(root, root / "sessions.txt", options);
  }
  Parts parts = parts_of("logs", "drive logs, sessions in order of their names, frames by the numbers of their files",
                         root, options);
  if (looks_like_log(root, options.log)) {
    parts.sessions.push_back({0, root.filename().string(), root, true});
    return parts;
  }
  for (const fs::path& drive : folders_and_rawlogs(root)) {
    if (looks_like_log(drive, options.log)) {
      parts.sessions.push_back({static_cast<int>(parts.sessions.size()), drive.filename().string(), drive, true});
    }
  }
  return parts.sessions.empty() ? std::nullopt : std::optional(std::move(parts));
}

Parts logs_of_sessions_file(const fs::path& root, const fs::path& file, const DatasetOptions& options) {
  Parts parts = parts_of("logs", "drive logs named by " + file.string() + ", frames by the numbers of their files",
                         root, options);
  const std::string text = storage::read_file(file);
  std::map<int, std::size_t> seen;
  std::size_t line_number = 0;
  for (const std::string_view line : text::split_lines(text)) {
    ++line_number;
    const auto words = text::split_words(line);
    if (words.empty() || words[0].front() == '#') {
      continue;
    }
    const auto number = text::parse_whole(words[0]);
    if (!number && line_number == 1) {
      continue;  // the header
    }
    const std::string place = std::to_string(line_number);
    if (!number || *number > 1'000'000 || words.size() < 2) {
      throw InputError(file.string(), place, "not a session number and the name of a log");
    }
    const auto session = static_cast<int>(*number);
    if (const auto [it, fresh] = seen.emplace(session, line_number); !fresh) {
      throw InputError(file.string(), place,
                       "session " + std::to_string(session) + " is already on line " + std::to_string(it->second));
    }
    // Names may hold spaces: everything from the second word on.
    const std::string name(line.substr(static_cast<std::size_t>(words[1].data() - line.data())));
    std::error_code error;
    parts.sessions.push_back({session, name, root / name, fs::exists(root / name, error)});
  }
  if (parts.sessions.empty()) {
    throw InputError(file.string(), "", "names no sessions");
  }
  return parts;
}

}  // namespace loopmark::io
