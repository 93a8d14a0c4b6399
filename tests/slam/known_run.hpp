// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A run in the making whose keyframes stand at known places, and a registrar that answers as a test tells it to.
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "../../libs/slam/src/keyframe_files.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/slam/records.hpp"
#include "loopmark/slam/registrar.hpp"

namespace loopmark::testing_support {

/// Finds out which keyframes it is asked about: the first point of each cloud carries the keyframe's number as its z.
struct ToldRegistrar : Registrar {
  /// What align and verify answer for two keyframes.
  std::function<RegistrationResult(std::size_t source, std::size_t target, bool submaps)> align_answer;
  std::function<RegistrationResult(std::size_t source, std::size_t target, const Pose& claimed)> verify_answer;

  std::string prepare(const PointCloud& cloud) const override { return "scan " + number(cloud); }
  std::string join(const std::vector<PointCloud>& clouds, const std::vector<Pose>& T_submap_scan) const override {
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      if (T_submap_scan[i].isApprox(Pose::Identity())) {
        return "submap " + number(clouds[i]);
      }
    }
    return "none";
  }
  RegistrationResult align(const std::string& source, const std::string& target) const override {
    return align_answer(keyframe(source), keyframe(target), source.starts_with("submap"));
  }
  RegistrationResult verify(const std::string& source, const std::string& target, const Pose& claimed) const override {
    return verify_answer(keyframe(source), keyframe(target), claimed);
  }

 private:
  static std::string number(const PointCloud& cloud) { return std::to_string(std::lround(cloud.points.front().z())); }
  static std::size_t keyframe(const std::string& bytes) { return std::stoul(bytes.substr(bytes.find(' '))); }
};

inline RegistrationResult sure_answer(const Pose& T_target_source) {
  RegistrationResult result;
  result.answered = true;
  result.p_correct = 0.97;
  result.T_target_source = T_target_source;
  result.covariance = 1e-4 * Matrix6d::Identity();
  return result;
}

inline RegistrationResult no_answer() {
  RegistrationResult result;
  result.p_correct = 0.1;
  result.reason = "told not to";
  return result;
}

/// Removed at the end of the scope.
class KnownRun {
 public:
  explicit KnownRun(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("loopmark_" + name + "_" + std::to_string(::getpid()))),
        folder_(make(path_)) {}
  ~KnownRun() { std::filesystem::remove_all(folder_.path()); }
  KnownRun(const KnownRun&) = delete;
  KnownRun& operator=(const KnownRun&) = delete;

  /// A scan that is a keyframe, at `truth` in a world of posts grown from `world`; `T_piece_world` is what its piece
  /// knows.
  void add(std::size_t piece, const Pose& truth, const Pose& T_piece_world, std::uint64_t world) {
    const std::size_t k = scans_.size();
    ScanRecord record;
    record.scan = k;
    record.stamp_s = static_cast<double>(k);
    record.state = k == 0 || scans_.back().piece != piece ? ScanState::kNewPiece : ScanState::kTracked;
    record.piece = piece;
    record.keyframe = k;
    record.T_piece_lidar = T_piece_world * truth;
    record.covariance = 1e-6 * Matrix6d::Identity();
    scans_.push_back(record);
    truth_.push_back(truth);
    write_files(k, truth, world);
  }

  const RunFolder& folder() const { return folder_; }
  const std::vector<ScanRecord>& scans() const { return scans_; }
  const Pose& truth(std::size_t keyframe) const { return truth_[keyframe]; }
  Pose true_motion(std::size_t source, std::size_t target) const { return truth_[target].inverse() * truth_[source]; }

 private:
  static RunFolder make(const std::filesystem::path& path) {
    std::filesystem::remove_all(path.string() + ".partial");
    return RunFolder::create(path);
  }

  void write_files(std::size_t k, const Pose& truth, std::uint64_t world) const {
    Rng rng(world);
    PointCloud cloud;
    cloud.points.emplace_back(0.0F, 0.0F, static_cast<float>(k));
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector3d post(rng.uniform(-60, 120), rng.uniform(-30, 30), rng.uniform(1, 6));
      cloud.points.push_back((truth.inverse() * post).cast<float>());
    }
    write_keyframe_cloud(folder_, k, cloud);
    write_keyframe_place(folder_, k, cloud);
    write_file_atomically(folder_.keyframe(k, "prepared"), ToldRegistrar().prepare(cloud));
  }

  std::filesystem::path path_;
  RunFolder folder_;
  std::vector<ScanRecord> scans_;
  std::vector<Pose> truth_;
};

}  // namespace loopmark::testing_support
