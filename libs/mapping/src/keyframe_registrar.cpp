// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/mapping/loop_closer.hpp"

namespace loopmark::mapping {

registration::PreparedCloudPtr KeyframeRegistrar::prepared(std::size_t keyframe) const {
  return registration::restore_file(registrar_, folder_.keyframe(keyframe, "prepared"));
}

registration::RegistrationResult KeyframeRegistrar::scans(std::size_t source, std::size_t target) const {
  return registrar_.align(*prepared(source), *prepared(target));
}

registration::RegistrationResult KeyframeRegistrar::verify(std::size_t source, std::size_t target,
                                                           const Pose& T_target_source) const {
  return registrar_.verify(*prepared(source), *prepared(target), T_target_source);
}

registration::RegistrationResult KeyframeRegistrar::submaps(std::size_t source, std::size_t target,
                                                            std::size_t count) const {
  return registrar_.align(*submap(source, count), *submap(target, count));
}

registration::PreparedCloudPtr KeyframeRegistrar::submap(std::size_t middle, std::size_t count) const {
  const std::size_t half = count / 2;
  const Pose T_submap_segment = keyframes_[middle].T_segment_lidar.inverse();
  std::vector<PointCloud> clouds;
  std::vector<Pose> T_submap_scan;
  for (std::size_t k = middle - std::min(half, middle); k <= middle + half && k < keyframes_.size(); ++k) {
    if (keyframes_[k].segment == keyframes_[middle].segment) {
      clouds.push_back(map_store::read_keyframe_cloud(folder_, k));
      T_submap_scan.push_back(T_submap_segment * keyframes_[k].T_segment_lidar);
    }
  }
  return registrar_.prepare_submap(clouds, T_submap_scan);
}

void store_result(const registration::RegistrationResult& result, map_store::LoopRecord& candidate) {
  candidate.answered = result.answered;
  candidate.reason = result.reason;
  candidate.p_correct = result.p_correct;
  candidate.T_target_source = result.T_target_source;
  candidate.covariance = result.covariance;
  candidate.evidence = result.modes.empty() ? registration::Evidence{} : result.modes.front().evidence;
}

}  // namespace loopmark::mapping
