// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/record_rules.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/core/error.hpp"

namespace loopmark::map_store {
namespace {

constexpr double kFarthest = 1e8;          // metres: beyond any map on this planet
constexpr double kLargestVariance = 1e16;  // of a pose that nothing holds; its square stays far from overflow
constexpr double kLatest = 1e12;           // seconds since 1970
constexpr double kNotRigid = 1e-4;         // |R R^T - I|: rounding over a million poses stays far below

/// One record that is looked at.
class Rules {
 public:
  Rules(const std::filesystem::path& file, std::size_t index) : file_(file), line_(index + 1) {}

  void require(bool good, const std::string& problem) const {
    if (!good) {
      throw InputError(file_.string(), "line " + std::to_string(line_), problem,
                       "the run was changed or damaged: copy it again, or map its log again");
    }
  }

  void rigid(const Pose& pose, const char* what) const {
    const Eigen::Matrix3d R = pose.linear();
    const bool good = pose.matrix().allFinite() && pose.translation().norm() < kFarthest &&
                      (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kNotRigid &&
                      R.determinant() > 0.0;
    require(good, std::string(what) + " is no pose");
  }

  void covariance(const Matrix6d& value) const {
    require(value.allFinite() && value.cwiseAbs().maxCoeff() < kLargestVariance && value.diagonal().minCoeff() >= 0.0,
            "the covariance is none");
  }

 private:
  const std::filesystem::path& file_;
  std::size_t line_;
};

bool is_share(double value) { return value >= 0.0 && value <= 1.0; }

void require_values(const ScanRecord& scan, const Rules& rules) {
  rules.require(scan.state >= ScanState::kTracked && scan.state <= ScanState::kDamaged, "the state is unknown");
  rules.require(scan.tracking >= odometry::Tracking::kGood && scan.tracking <= odometry::Tracking::kLost,
                "the tracking is unknown");
  rules.require(std::abs(scan.stamp_s) < kLatest, "the time is none");
  rules.rigid(scan.T_segment_lidar, "where the scan stands");
  rules.require(scan.velocity.allFinite() && scan.velocity.cwiseAbs().maxCoeff() < kFarthest, "the velocity is none");
  rules.require(is_share(scan.inlier_share), "the share of inliers is not within 0 and 1");
  rules.require(scan.residual_m >= 0.0 && scan.residual_m < kFarthest, "the residual is none");
  rules.require(scan.degenerate <= 3, "there are three directions of translation");
  rules.covariance(scan.covariance);
}

}  // namespace

std::size_t keyframes_in(const std::vector<ScanRecord>& scans) {
  return static_cast<std::size_t>(
      std::count_if(scans.begin(), scans.end(), [](const ScanRecord& s) { return s.keyframe.has_value(); }));
}

void require_sound(const std::vector<ScanRecord>& scans, const std::filesystem::path& file) {
  std::size_t keyframes = 0;
  std::size_t segment = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const ScanRecord& scan = scans[i];
    const Rules rules(file, i);
    rules.require(scan.scan == i,
                  "scan " + std::to_string(scan.scan) + " stands where " + std::to_string(i) + " is due");
    const bool next_segment = i > 0 && scan.segment == segment + 1;
    rules.require(scan.segment == segment || next_segment,
                  "segment " + std::to_string(scan.segment) + " follows segment " + std::to_string(segment));
    segment = scan.segment;
    if (scan.keyframe) {
      rules.require(*scan.keyframe == keyframes, "keyframe " + std::to_string(*scan.keyframe) + " stands where " +
                                                     std::to_string(keyframes) + " is due");
      rules.require(scan.state != ScanState::kDamaged, "a keyframe was made of a damaged scan");
      ++keyframes;
    }
    rules.require(keyframes > 0 || scan.state == ScanState::kDamaged, "no keyframe comes before this scan");
    require_values(scan, rules);
  }
}

void require_sound(const std::vector<LoopRecord>& loops, std::size_t keyframes, const std::filesystem::path& file) {
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopRecord& loop = loops[i];
    const Rules rules(file, i);
    rules.require(loop.source < keyframes && loop.target < loop.source,
                  "a loop of keyframes " + std::to_string(loop.source) + " and " + std::to_string(loop.target) +
                      ": the run has " + std::to_string(keyframes) + ", and the later comes first");
    rules.require(is_share(loop.p_correct), "the probability is not within 0 and 1");
    rules.rigid(loop.T_target_source, "the motion");
    rules.covariance(loop.covariance);
  }
}

void require_sound(const std::vector<LoopDecision>& decisions, std::size_t keyframes,
                   const std::filesystem::path& file) {
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    Rules(file, i).require(decisions[i].source < keyframes && decisions[i].target < decisions[i].source,
                           "a decision about keyframes " + std::to_string(decisions[i].source) + " and " +
                               std::to_string(decisions[i].target) + ": the run has " + std::to_string(keyframes) +
                               ", and the later comes first");
  }
}

}  // namespace loopmark::map_store
