// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// MRPT rawlogs, without MRPT's types.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"

namespace loopmark::mrpt_bridge {

/// The LiDAR scans of a rawlog (gzip or plain; sensory frames or single observations) in order. Opening reads the
/// whole file once; reading scans in order costs no more than reading the file. Thread-safe.
class RawlogReader {
 public:
  /// Only observations with `sensor_label`; empty: those of the first LiDAR found. Throws InputError when the file
  /// cannot be read or holds no usable scan.
  RawlogReader(const std::filesystem::path& path, const std::string& sensor_label);
  ~RawlogReader();

  std::size_t size() const;
  double stamp_s(std::size_t index) const;
  /// "object 12, CObservationVelodyneScan": where the scan is in the file.
  std::string place(std::size_t index) const;
  /// Throws InputError naming the place.
  PointCloud read(std::size_t index) const;

  const std::string& sensor_label() const;
  /// What is wrong with the file behind its last usable scan ("truncated at byte 123"); empty when nothing is.
  const std::string& problem() const;

  /// Poses T_world_sensor that the log holds as CObservationRobotPose labelled "truth" or "ground_truth", with their
  /// stamps.
  struct Truth {
    std::vector<double> stamps_s;
    std::vector<Pose> poses;
  };
  const Truth& truth() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a rawlog (gzip) scan by scan; it is renamed to its name when it is whole.
class RawlogWriter {
 public:
  RawlogWriter(std::filesystem::path path, std::string sensor_label);
  ~RawlogWriter();

  /// Adds a scan and, where given, its reference pose T_world_sensor. Throws InputError when the disk is full.
  void add(const Scan& scan, const std::optional<Pose>& truth = std::nullopt);

  /// Ends the file and gives it its name. Without it the partial file is removed.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace loopmark::mrpt_bridge
