// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// nuScenes: JSON tables beside samples/ and sweeps/ (Caesar et al., "nuScenes: A multimodal dataset for autonomous
// driving", CVPR 2020). A session is a scene in the order of scene.json, a frame any LIDAR_TOP sweep of it.
#include <fstream>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <unordered_set>

#include "dataset_layouts.hpp"
#include "file_log.hpp"
#include "layout_parts.hpp"

namespace loopmark::io {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

/// Calls `row` with each object of a table, which is an array of objects, without keeping the table.
template <class Row>
void each_row(const fs::path& file, const Row& row) {
  std::ifstream stream(file);
  if (!stream) {
    throw InputError(file.string(), "", "cannot read", "the tables of nuScenes must be complete");
  }
  const Json::parser_callback_t callback = [&row](int depth, Json::parse_event_t event, Json& value) {
    if (depth == 1 && event == Json::parse_event_t::object_end) {
      row(value);
      return false;  // done with it
    }
    return true;
  };
  try {
    [[maybe_unused]] const Json nothing = Json::parse(stream, callback);
  } catch (const Json::exception& error) {
    throw InputError(file.string(), "", error.what());
  }
}

Pose pose_of(const Json& row) {
  const std::vector<double> t = row.at("translation");
  const std::vector<double> q = row.at("rotation");  // w x y z
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(t.at(0), t.at(1), t.at(2));
  pose.linear() = Eigen::Quaterniond(q.at(0), q.at(1), q.at(2), q.at(3)).normalized().toRotationMatrix();
  return pose;
}

struct Sweep {
  std::string file;
  std::string next;  ///< token of the sweep after it; empty at the end of the scene
  std::string ego_pose;
  std::string calibration;
  double stamp_s = 0.0;
};

/// What the tables say about the LIDAR_TOP sweeps; read when the first scene is opened.
class Tables {
 public:
  Tables(fs::path root, std::string version) : root_(std::move(root)), folder_(root_ / version) {}

  /// All sweeps from the first sample of a scene to its end, the clouds moved into the car's frame.
  std::unique_ptr<DriveLog> scene(const SessionInfo& session, const std::string& first_sample,
                                  const LogOptions& options) {
    std::call_once(once_, [this] { read(); });
    std::vector<const Sweep*> chain;
    std::vector<fs::path> files;
    for (std::string token = first_sweep_[first_sample]; !token.empty() && chain.size() <= sweeps_.size();) {
      const auto sweep = sweeps_.find(token);
      if (sweep == sweeps_.end()) {
        throw InputError((folder_ / "sample_data.json").string(), session.name, "there is no sweep " + token);
      }
      chain.push_back(&sweep->second);
      files.push_back(root_ / sweep->second.file);
      token = sweep->second.next;
    }
    if (chain.empty()) {
      throw InputError((folder_ / "sample_data.json").string(), session.name, "no LIDAR_TOP sweep in this scene");
    }
    return std::make_unique<internal::FileLog>(log_parts(session, chain, std::move(files), options));
  }

 private:
  internal::FileLogParts log_parts(const SessionInfo& session, const std::vector<const Sweep*>& chain,
                                   std::vector<fs::path> files, const LogOptions& options) const {
    internal::FileLogParts parts = internal::parts_of_files(std::move(files), session.path, options);
    parts.info.format = "nuscenes";
    parts.info.path = session.path;
    parts.info.stamps_given = true;
    parts.info.stamps_source = "sample_data.json";
    parts.info.truth_given = true;
    parts.info.truth_source = (folder_ / "ego_pose.json").string();
    parts.T_cloud_sensor = find(calibrations_, chain.front()->calibration, "calibrated_sensor.json");
    for (std::size_t i = 0; i < chain.size(); ++i) {
      parts.stamps_s[i] = chain[i]->stamp_s;
      parts.frame_numbers[i] = i;
      parts.truth.push_back(find(ego_poses_, chain[i]->ego_pose, "ego_pose.json"));
    }
    return parts;
  }

  Pose find(const std::unordered_map<std::string, Pose>& poses, const std::string& token, const char* table) const {
    const auto pose = poses.find(token);
    if (pose == poses.end()) {
      throw InputError((folder_ / table).string(), "", "no entry " + token, "the tables do not belong together");
    }
    return pose->second;
  }

  void read() {
    std::unordered_set<std::string> wanted;
    each_row(folder_ / "sample_data.json", [&](const Json& row) {
      const std::string file = row.at("filename");
      if (file.find("LIDAR_TOP") == std::string::npos) {
        return;
      }
      const std::string token = row.at("token");
      Sweep sweep{file, row.at("next"), row.at("ego_pose_token"), row.at("calibrated_sensor_token"),
                  row.at("timestamp").get<double>() * 1e-6};
      wanted.insert(sweep.ego_pose);
      if (row.at("is_key_frame").get<bool>()) {
        first_sweep_.emplace(row.at("sample_token").get<std::string>(), token);
      }
      sweeps_.emplace(token, std::move(sweep));
    });
    each_row(folder_ / "ego_pose.json", [&](const Json& row) {
      if (const std::string token = row.at("token"); wanted.count(token) > 0) {
        ego_poses_.emplace(token, pose_of(row));
      }
    });
    each_row(folder_ / "calibrated_sensor.json",
             [&](const Json& row) { calibrations_.emplace(row.at("token").get<std::string>(), pose_of(row)); });
  }

  fs::path root_;
  fs::path folder_;
  std::once_flag once_;
  std::unordered_map<std::string, Sweep> sweeps_;             ///< by token
  std::unordered_map<std::string, std::string> first_sweep_;  ///< key frame's sweep by the token of its sample
  std::unordered_map<std::string, Pose> ego_poses_;           ///< T_world_car
  std::unordered_map<std::string, Pose> calibrations_;        ///< T_car_sensor
};

/// The version of the tables to read. Throws InputError when several are there and none is asked for.
std::optional<std::string> version_of(const fs::path& root, const std::string& asked) {
  std::vector<std::string> found;
  std::error_code error;
  for (const fs::path& folder : internal::list_folders(root)) {
    const std::string name = folder.filename().string();
    if (name.starts_with("v1.0-") && fs::exists(folder / "scene.json", error)) {
      found.push_back(name);
    }
  }
  if (asked != "auto") {
    return fs::exists(root / asked / "scene.json", error) ? std::optional(asked) : std::nullopt;
  }
  if (found.size() > 1) {
    throw InputError(root.string(), "", "nuScenes tables of several versions: " + found[0] + ", " + found[1],
                     "choose one with dataset.version; the published test sets are of v1.0-test, training and "
                     "validation of v1.0-trainval");
  }
  return found.empty() ? std::nullopt : std::optional(found.front());
}

}  // namespace

std::optional<Dataset::Parts> find_nuscenes(const fs::path& root, const DatasetOptions& options) {
  const std::optional<std::string> version = version_of(root, options.version);
  if (!version) {
    return std::nullopt;
  }
  Dataset::Parts parts;
  parts.layout = "nuscenes";
  parts.description = "nuScenes " + *version +
                      ": LIDAR_TOP sweeps at 20 Hz moved into the car's frame, frames from 0 in "
                      "order of time, session = place of the scene in scene.json; the poses hold no usable height";
  parts.root = root;
  auto first_samples = std::make_shared<std::vector<std::string>>();
  each_row(root / *version / "scene.json", [&](const Json& row) {
    const std::string name = row.at("name");
    parts.sessions.push_back({static_cast<int>(parts.sessions.size()), name, root / *version / name, true});
    first_samples->push_back(row.at("first_sample_token"));
  });
  auto tables = std::make_shared<Tables>(root, *version);
  parts.open = [tables, first_samples, log = options.log](const SessionInfo& session) {
    return tables->scene(session, first_samples->at(static_cast<std::size_t>(session.number)), log);
  };
  return parts;
}

}  // namespace loopmark::io
