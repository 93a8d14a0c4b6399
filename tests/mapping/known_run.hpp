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

#include "loopmark/core/random.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/map_store/records.hpp"
#include "loopmark/registration/pair_registration.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::testing_support {

/// Finds out which keyframes it is asked about: the first point of each cloud carries the keyframe's number as its z.
struct ToldCloud : registration::PreparedCloud {
  explicit ToldCloud(std::string what) : told(std::move(what)) {}
  std::string to_bytes() const override { return told; }
  const std::string told;
};

struct ToldRegistrar : registration::PairRegistration {
  /// What align and verify answer for two keyframes.
  std::function<registration::RegistrationResult(std::size_t source, std::size_t target, bool submaps)> align_answer;
  std::function<registration::RegistrationResult(std::size_t source, std::size_t target, const Pose& claimed)>
      verify_answer;

  const std::string& name() const override { return name_; }
  registration::PreparedCloudPtr prepare(const PointCloud& cloud) const override {
    return std::make_shared<ToldCloud>("scan " + number(cloud));
  }
  registration::PreparedCloudPtr prepare_submap(const std::vector<PointCloud>& clouds,
                                                const std::vector<Pose>& T_submap_scan) const override {
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      if (T_submap_scan[i].isApprox(Pose::Identity())) {
        return std::make_shared<ToldCloud>("submap " + number(clouds[i]));
      }
    }
    return std::make_shared<ToldCloud>("none");
  }
  registration::PreparedCloudPtr restore(const std::string& bytes) const override {
    return std::make_shared<ToldCloud>(bytes);
  }
  registration::RegistrationResult align(const registration::PreparedCloud& source,
                                         const registration::PreparedCloud& target) const override {
    return align_answer(keyframe(source), keyframe(target), source.to_bytes().starts_with("submap"));
  }
  registration::RegistrationResult verify(const registration::PreparedCloud& source,
                                          const registration::PreparedCloud& target,
                                          const Pose& claimed) const override {
    return verify_answer(keyframe(source), keyframe(target), claimed);
  }

 private:
  static std::string number(const PointCloud& cloud) { return std::to_string(std::lround(cloud.points.front().z())); }
  static std::size_t keyframe(const registration::PreparedCloud& cloud) {
    const std::string told = cloud.to_bytes();
    return std::stoul(told.substr(told.find(' ')));
  }
  std::string name_ = "told";
};

inline registration::RegistrationResult sure_answer(const Pose& T_target_source) {
  registration::RegistrationResult result;
  result.answered = true;
  result.p_correct = 0.97;
  result.T_target_source = T_target_source;
  result.covariance = 1e-4 * Matrix6d::Identity();
  return result;
}

inline registration::RegistrationResult no_answer() {
  registration::RegistrationResult result;
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

  /// A scan that is a keyframe, at `truth` in a world of posts grown from `world`; `T_segment_world` is what its
  /// segment knows.
  void add(std::size_t segment, const Pose& truth, const Pose& T_segment_world, std::uint64_t world) {
    const std::size_t k = scans_.size();
    map_store::ScanRecord record;
    record.scan = k;
    record.stamp_s = static_cast<double>(k);
    record.state =
        k == 0 || scans_.back().segment != segment ? map_store::ScanState::kNewSegment : map_store::ScanState::kTracked;
    record.segment = segment;
    record.keyframe = k;
    record.T_segment_lidar = T_segment_world * truth;
    record.covariance = 1e-6 * Matrix6d::Identity();
    scans_.push_back(record);
    truth_.push_back(truth);
    write_files(k, truth, world);
  }

  const map_store::RunFolder& folder() const { return folder_; }
  const std::vector<map_store::ScanRecord>& scans() const { return scans_; }
  const Pose& truth(std::size_t keyframe) const { return truth_[keyframe]; }
  Pose true_motion(std::size_t source, std::size_t target) const { return truth_[target].inverse() * truth_[source]; }

 private:
  static map_store::RunFolder make(const std::filesystem::path& path) {
    std::filesystem::remove_all(path.string() + ".partial");
    return map_store::RunFolder::create(path);
  }

  void write_files(std::size_t k, const Pose& truth, std::uint64_t world) const {
    Rng rng(world);
    PointCloud cloud;
    cloud.points.emplace_back(0.0F, 0.0F, static_cast<float>(k));
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector3d post(rng.uniform(-60, 120), rng.uniform(-30, 30), rng.uniform(1, 6));
      cloud.points.push_back((truth.inverse() * post).cast<float>());
    }
    map_store::write_keyframe_cloud(folder_, k, cloud);
    map_store::write_keyframe_place(folder_, k, cloud);
    storage::write_file_atomically(folder_.keyframe(k, "prepared"), ToldRegistrar().prepare(cloud)->to_bytes());
  }

  std::filesystem::path path_;
  map_store::RunFolder folder_;
  std::vector<map_store::ScanRecord> scans_;
  std::vector<Pose> truth_;
};

}  // namespace loopmark::testing_support
