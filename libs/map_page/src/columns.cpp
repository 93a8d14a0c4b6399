// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loopmark/web_page/block.hpp"

namespace loopmark::map_page::internal {
namespace {

using web_page::block;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

void append(std::vector<float>& values, const Eigen::Vector3d& v) {
  for (int axis = 0; axis < 3; ++axis) {
    values.push_back(static_cast<float>(v[axis]));
  }
}

/// x y z qx qy qz qw.
void append(std::vector<float>& values, const Pose& pose) {
  append(values, Eigen::Vector3d(pose.translation()));
  const Eigen::Quaterniond q(pose.linear());
  for (const double part : {q.x(), q.y(), q.z(), q.w()}) {
    values.push_back(static_cast<float>(part));
  }
}

/// The rigid motion that lays the true positions of the scans in the map on the estimated ones (Umeyama 1991).
Pose fit_of_truth(const MapRecords& r) {
  std::vector<std::size_t> in_map;
  for (std::size_t i = 0; i < r.scans.size(); ++i) {
    if (r.map.component[i] == 0 && r.truth[i].translation().allFinite()) {
      in_map.push_back(i);
    }
  }
  if (in_map.empty()) {
    return Pose::Identity();
  }
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(in_map.size()));
  Eigen::Matrix3Xd to = from;
  for (std::size_t i = 0; i < in_map.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = r.truth[in_map[i]].translation();
    to.col(static_cast<Eigen::Index>(i)) = r.map.T_map_scan[in_map[i]].translation();
  }
  return Pose(Eigen::umeyama(from, to, false));
}

std::string truth_blocks(const MapRecords& r) {
  if (r.truth.empty()) {
    return "";
  }
  const Pose T_map_world = fit_of_truth(r);
  std::vector<float> truth;
  std::vector<float> error;
  for (std::size_t i = 0; i < r.scans.size(); ++i) {
    const Eigen::Vector3d at = T_map_world * r.truth[i].translation();
    const bool known = r.map.component[i] == 0 && at.allFinite();
    append(truth, known ? at : Eigen::Vector3d::Constant(kNone));
    error.push_back(known ? static_cast<float>((r.map.T_map_scan[i].translation() - at).norm()) : kNone);
  }
  return web_page::block("scan.truth", truth) + web_page::block("scan.error", error);
}

/// Metres between where the map and where odometry puts each scan, seen from the first scan of its segment.
std::vector<float> moved(const MapRecords& r) {
  std::vector<float> result;
  std::size_t first = 0;
  for (std::size_t i = 0; i < r.scans.size(); ++i) {
    first = r.scans[i].segment == r.scans[first].segment ? first : i;
    const Pose T_map_segment = r.map.T_map_scan[first] * r.scans[first].T_segment_lidar.inverse();
    const Eigen::Vector3d before = T_map_segment * r.scans[i].T_segment_lidar.translation();
    result.push_back(static_cast<float>((r.map.T_map_scan[i].translation() - before).norm()));
  }
  return result;
}

/// vetoed and forced by a person, else as the map was solved (0 accepted, 1 rejected, 2 vetoed, 3 forced).
std::uint8_t verdict_of(const MapRecords& r, std::size_t i) {
  const auto loop_override = map_store::loop_override_of(r.decisions, r.loops[i].source, r.loops[i].target);
  if (loop_override) {
    return *loop_override == map_store::LoopOverride::kVeto ? 2 : 3;
  }
  return r.map.loops[i].accepted ? 0 : 1;
}

void note_evidence(const map_store::LoopRecord& loop, std::vector<std::string>& names) {
  for (const auto& [name, value] : loop.evidence) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
    }
  }
}

std::vector<float> evidence_matrix(const MapRecords& r, const std::vector<std::string>& names) {
  std::vector<float> values(r.loops.size() * names.size(), kNone);
  for (std::size_t i = 0; i < r.loops.size(); ++i) {
    for (const auto& [name, value] : r.loops[i].evidence) {
      const auto column = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
      values[i * names.size() + column] = static_cast<float>(value);
    }
  }
  return values;
}

}  // namespace

std::size_t Dictionary::number(const std::string& word) {
  const auto found = std::find(words_.begin(), words_.end(), word);
  if (found == words_.end()) {
    words_.push_back(word);
    return words_.size() - 1;
  }
  return static_cast<std::size_t>(found - words_.begin());
}

std::string scan_blocks(const MapRecords& r) {
  std::vector<double> stamp;
  std::vector<float> position, odometry, sigma, inliers, speed;
  std::vector<std::uint8_t> state, tracking;
  std::vector<std::uint16_t> component, segment;
  for (std::size_t i = 0; i < r.scans.size(); ++i) {
    const map_store::ScanRecord& scan = r.scans[i];
    stamp.push_back(scan.stamp_s);
    append(position, Eigen::Vector3d(r.map.T_map_scan[i].translation()));
    append(odometry, Eigen::Vector3d(scan.T_segment_lidar.translation()));
    append(sigma, position_sigma(r.map.T_map_scan[i], r.map.covariance[i]));
    inliers.push_back(static_cast<float>(scan.inlier_share));
    speed.push_back(static_cast<float>(scan.velocity.head<3>().norm()));
    state.push_back(static_cast<std::uint8_t>(scan.state));
    tracking.push_back(static_cast<std::uint8_t>(scan.tracking));
    component.push_back(static_cast<std::uint16_t>(r.map.component[i]));
    segment.push_back(static_cast<std::uint16_t>(scan.segment));
  }
  return web_page::block("scan.stamp", stamp) + web_page::block("scan.position", position) +
         web_page::block("scan.odometry", odometry) + web_page::block("scan.sigma", sigma) +
         web_page::block("scan.inliers", inliers) + web_page::block("scan.speed", speed) +
         web_page::block("scan.state", state) + web_page::block("scan.tracking", tracking) +
         web_page::block("scan.component", component) + web_page::block("scan.segment", segment) +
         web_page::block("scan.moved", moved(r)) + truth_blocks(r);
}

std::string keyframe_blocks(const MapRecords& r) {
  std::vector<std::uint32_t> scan;
  std::vector<float> pose, odometry, path;
  for (const mapping::Keyframe& keyframe : r.map.keyframes) {
    scan.push_back(static_cast<std::uint32_t>(keyframe.scan));
    append(pose, r.map.T_map_keyframe[keyframe.number]);
    append(odometry, keyframe.T_segment_lidar);
    path.push_back(static_cast<float>(keyframe.path_m));
  }
  return web_page::block("keyframe.scan", scan) + web_page::block("keyframe.pose", pose) +
         web_page::block("keyframe.odometry", odometry) + web_page::block("keyframe.path", path);
}

std::string loop_blocks(const MapRecords& r, LoopWords& words) {
  std::vector<std::uint32_t> source, target;
  std::vector<std::uint8_t> verdict, origin, answered;
  std::vector<std::uint16_t> reason;
  std::vector<float> p, motion, weight, chi2;
  for (std::size_t i = 0; i < r.loops.size(); ++i) {
    const map_store::LoopRecord& loop = r.loops[i];
    const mapping::LoopVerdict& found = r.map.loops[i];
    source.push_back(static_cast<std::uint32_t>(loop.source));
    target.push_back(static_cast<std::uint32_t>(loop.target));
    verdict.push_back(verdict_of(r, i));
    origin.push_back(static_cast<std::uint8_t>(words.origins.number(loop.origin)));
    reason.push_back(static_cast<std::uint16_t>(words.reasons.number(found.reason)));
    answered.push_back(loop.answered ? 1 : 0);
    p.push_back(static_cast<float>(loop.p_correct));
    append(motion, loop.T_target_source);
    weight.push_back(static_cast<float>(found.edge ? found.weight : 0.0));
    chi2.push_back(static_cast<float>(found.edge ? found.chi2 : 0.0));
    note_evidence(loop, words.evidence);
  }
  return web_page::block("loop.source", source) + web_page::block("loop.target", target) +
         web_page::block("loop.p", p) + web_page::block("loop.verdict", verdict) +
         web_page::block("loop.origin", origin) + web_page::block("loop.reason", reason) +
         web_page::block("loop.motion", motion) + web_page::block("loop.answered", answered) +
         web_page::block("loop.weight", weight) + web_page::block("loop.chi2", chi2) +
         web_page::block("loop.evidence", evidence_matrix(r, words.evidence));
}

}  // namespace loopmark::map_page::internal
