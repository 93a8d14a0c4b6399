// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Data sets of many drives, addressed as the balanced sets of frame pairs do: session number, frame number.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/io/drive_log.hpp"

namespace loopmark::io {

struct DatasetOptions {
  std::string layout = "auto";   ///< forces a layout
  std::string version = "auto";  ///< nuScenes: v1.0-trainval, v1.0-test, v1.0-mini
  LogOptions log;                ///< for the drives; a section of its own where options come from a file
};

template <class Visitor>
void describe(Visitor& v, DatasetOptions& o) {
  v.field("layout", o.layout,
          "auto, or the layout to force: kitti-odometry, kitti-raw, nuscenes, apollo-southbay, mulran, logs");
  v.field("version", o.version, "nuScenes tables: auto, v1.0-trainval, v1.0-test or v1.0-mini");
}

/// One drive of a data set.
struct SessionInfo {
  int number = 0;              ///< session_ind of the pairs files
  std::string name;            ///< "08", "scene-0061", "TestData/HighWay237/2018-10-12"
  std::filesystem::path path;  ///< of the drive; it need not be there (partial copies of a data set)
  bool present = false;
};

/// The drives below one root folder. Reading is thread-safe; drives are opened when first asked for.
class Dataset {
 public:
  struct Parts;
  explicit Dataset(Parts parts);
  ~Dataset();

  const std::string& layout() const;
  const std::filesystem::path& root() const;
  const std::vector<SessionInfo>& sessions() const;

  /// The drive. Throws InputError when the set does not know the session or it is not there.
  const DriveLog& log(int session) const;

  /// The place in log(session) of a frame number. Throws InputError for a frame that does not exist,
  /// and says which frames do (Apollo-SouthBay counts from 1).
  std::size_t frame_index(int session, long frame) const;

  /// The cloud of a frame, in the frame of poses(): the sensor's, or the car's for nuScenes.
  PointCloud load(int session, long frame) const;

  /// Reference poses T_world_cloud of all frames of log(session), in its order; empty where none are given.
  std::vector<Pose> poses(int session) const;

  /// Conventions in words: frames, first frame number, rate.
  const std::string& describe() const;

 private:
  struct Session;
  const Session& session(int number) const;

  std::unique_ptr<Parts> parts_;
  std::vector<std::unique_ptr<Session>> opened_;
};

/// Finds out the layout of the data set under `root`: KITTI odometry (sequences/NN), KITTI raw
/// (DATE/DRIVE/velodyne_points), nuScenes (v1.0-*/scene.json), Apollo-SouthBay (TestData/HighWay237/2018-10-12/pcds,
/// ...), MulRan (DRIVE/Ouster) or a folder of logs (folders and .rawlog files; a sessions.txt there names them). With a
/// `sessions_file` (lines "NUMBER NAME", the first line may be a header) session NUMBER is the log root/NAME.
std::unique_ptr<Dataset> open_dataset(const std::filesystem::path& root,
                                      const std::filesystem::path& sessions_file = {},
                                      const DatasetOptions& options = {});

}  // namespace loopmark::io
