// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "peers.hpp"

#ifdef LOOPMARK_HAVE_OPEN3D
#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/CorrespondenceChecker.h>
#include <open3d/pipelines/registration/FastGlobalRegistration.h>
#include <open3d/pipelines/registration/Feature.h>
#include <open3d/pipelines/registration/Registration.h>
#include <open3d/utility/Random.h>

namespace loopmark::benchmarks {
namespace {

namespace o3d = open3d::pipelines::registration;

constexpr double kMatchDistance = 0.6;

struct Scan {
  open3d::geometry::PointCloud cloud;
  std::shared_ptr<o3d::Feature> features;
};

PeerLibrary::Scan prepare(const std::vector<Eigen::Vector3f>& points) {
  open3d::geometry::PointCloud raw;
  for (const Eigen::Vector3f& p : points) {
    raw.points_.push_back(p.cast<double>());
  }
  const auto scan = std::make_shared<Scan>();
  scan->cloud = *raw.VoxelDownSample(0.3);
  scan->cloud.EstimateNormals(open3d::geometry::KDTreeSearchParamHybrid(1.2, 30));
  scan->features = o3d::ComputeFPFHFeature(scan->cloud, open3d::geometry::KDTreeSearchParamHybrid(2.4, 100));
  return scan;
}

const Scan& scan_of(const void* prepared) { return *static_cast<const Scan*>(prepared); }

std::optional<Pose> answer_of(const o3d::RegistrationResult& result) {
  Pose T = Pose::Identity();
  T.matrix() = result.transformation_;
  return result.correspondence_set_.empty() ? std::nullopt : std::optional(T);
}

std::optional<Pose> ransac(const void* source, const void* target) {
  open3d::utility::random::Seed(0);
  const o3d::CorrespondenceCheckerBasedOnEdgeLength edges(0.9);
  const o3d::CorrespondenceCheckerBasedOnDistance distance(kMatchDistance);
  return answer_of(o3d::RegistrationRANSACBasedOnFeatureMatching(
      scan_of(source).cloud, scan_of(target).cloud, *scan_of(source).features, *scan_of(target).features, true,
      kMatchDistance, o3d::TransformationEstimationPointToPoint(false), 3, {edges, distance},
      o3d::RANSACConvergenceCriteria(100000, 0.999)));
}

std::optional<Pose> fast_global(const void* source, const void* target) {
  open3d::utility::random::Seed(0);
  o3d::FastGlobalRegistrationOption option;
  option.maximum_correspondence_distance_ = kMatchDistance;
  return answer_of(o3d::FastGlobalRegistrationBasedOnFeatureMatching(
      scan_of(source).cloud, scan_of(target).cloud, *scan_of(source).features, *scan_of(target).features, option));
}

}  // namespace

std::optional<PeerLibrary> open3d_library() {
  return PeerLibrary{"open3d", prepare, {{"open3d-ransac", ransac}, {"open3d-fgr", fast_global}}, {}};
}

}  // namespace loopmark::benchmarks
#else
namespace loopmark::benchmarks {
std::optional<PeerLibrary> open3d_library() { return std::nullopt; }
}  // namespace loopmark::benchmarks
#endif
