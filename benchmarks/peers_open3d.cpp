// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "peers.hpp"

#ifdef LOOPMARK_HAVE_OPEN3D
#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/CorrespondenceChecker.h>
#include <open3d/pipelines/registration/FastGlobalRegistration.h>
#include <open3d/pipelines/registration/Registration.h>

namespace loopmark::benchmarks {
namespace {

namespace o3d = open3d::pipelines::registration;

struct Clouds {
  open3d::geometry::PointCloud source, target;
  o3d::CorrespondenceSet matches;

  explicit Clouds(const estimation::PointPairs& pairs) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      source.points_.push_back(pairs.source[i].cast<double>());
      target.points_.push_back(pairs.target[i].cast<double>());
      matches.emplace_back(static_cast<int>(i), static_cast<int>(i));
    }
  }
};

Pose pose_of(const o3d::RegistrationResult& result) {
  Pose T = Pose::Identity();
  T.matrix() = result.transformation_;
  return T;
}

Pose ransac(const estimation::PointPairs& pairs) {
  const Clouds clouds(pairs);
  const o3d::CorrespondenceCheckerBasedOnEdgeLength edges(0.9);
  const o3d::CorrespondenceCheckerBasedOnDistance distance(0.6);
  return pose_of(o3d::RegistrationRANSACBasedOnCorrespondence(
      clouds.source, clouds.target, clouds.matches, 0.6, o3d::TransformationEstimationPointToPoint(false), 3,
      {edges, distance}, o3d::RANSACConvergenceCriteria(100000, 0.999)));
}

Pose fast_global(const estimation::PointPairs& pairs) {
  const Clouds clouds(pairs);
  o3d::FastGlobalRegistrationOption option;
  option.maximum_correspondence_distance_ = 0.6;
  return pose_of(
      o3d::FastGlobalRegistrationBasedOnCorrespondence(clouds.source, clouds.target, clouds.matches, option));
}

}  // namespace

std::vector<NamedEstimator> open3d_estimators() { return {{"Open3D RANSAC", ransac}, {"Open3D FGR", fast_global}}; }

}  // namespace loopmark::benchmarks
#else
namespace loopmark::benchmarks {
std::vector<NamedEstimator> open3d_estimators() { return {}; }
}  // namespace loopmark::benchmarks
#endif
