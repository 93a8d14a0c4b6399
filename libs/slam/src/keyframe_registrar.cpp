// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "keyframe_files.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/slam/loop_closer.hpp"

namespace loopmark {

RegistrationResult KeyframeRegistrar::scans(std::size_t source, std::size_t target) const {
  return registrar_.align(read_file(folder_.keyframe(source, "prepared")),
                          read_file(folder_.keyframe(target, "prepared")));
}

RegistrationResult KeyframeRegistrar::verify(std::size_t source, std::size_t target,
                                             const Pose& T_target_source) const {
  return registrar_.verify(read_file(folder_.keyframe(source, "prepared")),
                           read_file(folder_.keyframe(target, "prepared")), T_target_source);
}

RegistrationResult KeyframeRegistrar::submaps(std::size_t source, std::size_t target, std::size_t count) const {
  return registrar_.align(submap(source, count), submap(target, count));
}

std::string KeyframeRegistrar::submap(std::size_t middle, std::size_t count) const {
  const std::size_t half = count / 2;
  const Pose T_submap_piece = keyframes_[middle].T_piece_lidar.inverse();
  std::vector<PointCloud> clouds;
  std::vector<Pose> T_submap_scan;
  for (std::size_t k = middle - std::min(half, middle); k <= middle + half && k < keyframes_.size(); ++k) {
    if (keyframes_[k].piece == keyframes_[middle].piece) {
      clouds.push_back(read_keyframe_cloud(folder_, k));
      T_submap_scan.push_back(T_submap_piece * keyframes_[k].T_piece_lidar);
    }
  }
  return registrar_.join(clouds, T_submap_scan);
}

void take_in(const RegistrationResult& result, LoopRecord& candidate) {
  candidate.answered = result.answered;
  candidate.reason = result.reason;
  candidate.p_correct = result.p_correct;
  candidate.T_target_source = result.T_target_source;
  candidate.covariance = result.covariance;
  candidate.evidence = result.modes.empty() ? Evidence{} : result.modes.front().evidence;
}

}  // namespace loopmark
