// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/dataset.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <string_view>

#include "dataset_layouts.hpp"

namespace loopmark::io {
namespace fs = std::filesystem;

/// A drive, opened when it is first asked for.
struct Dataset::Session {
  SessionInfo info;
  mutable std::once_flag once;
  mutable std::unique_ptr<DriveLog> log;
  mutable std::map<std::size_t, std::size_t> index_of_frame;
};

Dataset::Dataset(Parts parts) : parts_(std::make_unique<Parts>(std::move(parts))) {
  for (const SessionInfo& info : parts_->sessions) {
    opened_.push_back(std::make_unique<Session>());
    opened_.back()->info = info;
  }
}

Dataset::~Dataset() = default;

const std::string& Dataset::layout() const { return parts_->layout; }
const fs::path& Dataset::root() const { return parts_->root; }
const std::vector<SessionInfo>& Dataset::sessions() const { return parts_->sessions; }
const std::string& Dataset::describe() const { return parts_->description; }

const Dataset::Session& Dataset::session(int number) const {
  const auto it = std::find_if(opened_.begin(), opened_.end(),
                               [number](const auto& session) { return session->info.number == number; });
  const std::string root = parts_->root.string();
  if (it == opened_.end()) {
    throw InputError(root, "session " + std::to_string(number),
                     "the " + parts_->layout + " data here has no such session",
                     "are the pairs of another data set than the data?");
  }
  const Session& session = **it;
  if (!session.info.present) {
    throw InputError(session.info.path.string(), "session " + std::to_string(number),
                     "the drive " + session.info.name + " is not there", "add it to the data set's root folder");
  }
  std::call_once(session.once, [&] {
    auto log = parts_->open(session.info);
    for (std::size_t i = 0; i < log->size(); ++i) {
      session.index_of_frame.emplace(log->frame_number(i), i);
    }
    session.log = std::move(log);
  });
  return session;
}

const DriveLog& Dataset::log(int session_number) const { return *session(session_number).log; }

std::size_t Dataset::frame_index(int session_number, long frame) const {
  const Session& drive = session(session_number);
  const auto it = frame < 0 ? drive.index_of_frame.end() : drive.index_of_frame.find(static_cast<std::size_t>(frame));
  if (it == drive.index_of_frame.end()) {
    const std::size_t first = drive.index_of_frame.begin()->first;
    const std::size_t last = drive.index_of_frame.rbegin()->first;
    std::string remedy = "there are " + std::to_string(drive.index_of_frame.size()) + " frames, " +
                         std::to_string(first) + " to " + std::to_string(last);
    remedy += first == 1 && frame == 0 ? "; this set counts from 1" : "";
    throw InputError(drive.info.path.string(), "session " + std::to_string(session_number),
                     "frame " + std::to_string(frame) + " does not exist", remedy);
  }
  return it->second;
}

PointCloud Dataset::load(int session_number, long frame) const {
  return log(session_number).read(frame_index(session_number, frame)).cloud;
}

std::vector<Pose> Dataset::poses(int session_number) const { return log(session_number).truth(); }

namespace {

struct Layout {
  std::string_view name;
  std::optional<Dataset::Parts> (*find)(const fs::path& root, const DatasetOptions& options);
};

constexpr std::array kLayouts = {
    Layout{"nuscenes", io::find_nuscenes},   Layout{"kitti-odometry", io::find_kitti_odometry},
    Layout{"kitti-raw", io::find_kitti_raw}, Layout{"apollo-southbay", io::find_apollo_southbay},
    Layout{"mulran", io::find_mulran},       Layout{"logs", io::find_logs},
};

}  // namespace

std::unique_ptr<Dataset> open_dataset(const fs::path& root, const fs::path& sessions_file,
                                      const DatasetOptions& options) {
  check(options.log);
  std::error_code error;
  if (!fs::is_directory(root, error)) {
    throw InputError(root.string(), "", "no such folder", "give the root folder of a data set");
  }
  if (!sessions_file.empty()) {
    return std::make_unique<Dataset>(io::logs_of_sessions_file(root, sessions_file, options));
  }
  std::string known;
  bool name_known = options.layout == "auto";
  for (const Layout& layout : kLayouts) {
    known += (known.empty() ? "" : ", ") + std::string(layout.name);
    if (options.layout != "auto" && options.layout != layout.name) {
      continue;
    }
    name_known = true;
    if (auto parts = layout.find(root, options)) {
      return std::make_unique<Dataset>(std::move(*parts));
    }
  }
  require_option(name_known, "dataset.layout", "'" + options.layout + "' is none of auto, " + known);
  throw InputError(root.string(), "", "no data set of the layout '" + options.layout + "' found here",
                   "known are " + known);
}

}  // namespace loopmark::io
