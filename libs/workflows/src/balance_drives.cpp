// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/balance_drives.hpp"

#include <memory>
#include <sstream>
#include <stdexcept>

#include "loopmark/core/error.hpp"
#include "loopmark/io/dataset.hpp"
#include "loopmark/io/trajectory.hpp"

namespace loopmark::workflows {
namespace {

namespace fs = std::filesystem;

pair_sets::Drive drive_of(const io::DriveLog& log, int session, const std::string& name, std::vector<Pose> poses) {
  pair_sets::Drive drive;
  drive.session = session;
  drive.name = name;
  for (std::size_t i = 0; i < log.size(); ++i) {
    drive.frames.push_back(static_cast<int>(log.frame_number(i)));
    drive.stamps_s.push_back(log.stamp_s(i));
  }
  drive.T_world_cloud = std::move(poses);
  return drive;
}

/// The data set at a folder, unless the folder is one log or a plain folder of logs.
std::shared_ptr<io::Dataset> known_layout(const fs::path& path) {
  try {
    std::shared_ptr<io::Dataset> data = io::open_dataset(path);
    return data->layout() == "logs" ? nullptr : data;
  } catch (const InputError&) {
    return nullptr;
  }
}

std::vector<pair_sets::Drive> drives_of(const std::shared_ptr<io::Dataset>& data) {
  std::vector<pair_sets::Drive> drives;
  for (const io::SessionInfo& info : data->sessions()) {
    if (info.present) {
      const io::DriveLog& log = data->log(info.number);
      drives.push_back(drive_of(log, info.number, info.name, data->poses(info.number)));
      drives.back().load = [&log, data](std::size_t place) { return log.read(place).cloud; };
    }
  }
  return drives;
}

pair_sets::Drive drive_at(const fs::path& path, int session, const fs::path& poses) {
  const std::shared_ptr<io::DriveLog> log = io::open_log(path);
  std::vector<Pose> truth = poses.empty() ? log->truth() : io::read_trajectory(poses).poses;
  pair_sets::Drive drive = drive_of(*log, session, path.string(), std::move(truth));
  drive.load = [log](std::size_t place) { return log->read(place).cloud; };
  return drive;
}

/// The folder that all logs lie in.
fs::path common_parent(const std::vector<fs::path>& logs) {
  fs::path parent = fs::absolute(logs.front()).lexically_normal().parent_path();
  for (const fs::path& log : logs) {
    while (parent.has_relative_path() &&
           fs::absolute(log).lexically_normal().lexically_relative(parent).string().rfind("..", 0) == 0) {
      parent = parent.parent_path();
    }
  }
  return parent;
}

fs::path without_slash(const fs::path& path) { return path.has_filename() ? path : path.parent_path(); }

}  // namespace

DriveList open_drives(const std::vector<fs::path>& given, const fs::path& poses) {
  std::vector<fs::path> logs;
  for (const fs::path& path : given) {
    logs.push_back(without_slash(path));
  }
  DriveList list;
  const std::shared_ptr<io::Dataset> data = logs.size() == 1 ? known_layout(logs.front()) : nullptr;
  if (data) {
    list.drives = drives_of(data);
    list.root = logs.front();
  } else {
    if (!poses.empty() && logs.size() > 1) {
      throw InputError("--poses goes with a single log");
    }
    list.root = common_parent(logs);
    list.needs_sessions = true;
    for (std::size_t i = 0; i < logs.size(); ++i) {
      list.drives.push_back(drive_at(logs[i], static_cast<int>(i), poses));
      list.drives.back().name = fs::absolute(logs[i]).lexically_normal().lexically_relative(list.root).string();
    }
  }
  for (const pair_sets::Drive& drive : list.drives) {
    check(drive);
  }
  return list;
}

std::vector<int> parse_sessions(const std::string& text) {
  std::vector<int> sessions;
  std::istringstream parts(text);
  std::string part;
  try {
    while (std::getline(parts, part, ',')) {
      const std::size_t dash = part.find('-', 1);
      const int first = std::stoi(part);
      const int last = dash == std::string::npos ? first : std::stoi(part.substr(dash + 1));
      for (int session = first; session <= last; ++session) {
        sessions.push_back(session);
      }
    }
  } catch (const std::exception&) {
    throw InputError("not a list of sessions such as 0-4,7: '" + text + "'");
  }
  return sessions;
}

}  // namespace loopmark::workflows
