// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "peers.hpp"

#ifdef LOOPMARK_HAVE_PCL
#include <pcl/point_types.h>
#include <pcl/registration/sample_consensus_prerejective.h>

namespace loopmark::benchmarks {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

Cloud::Ptr cloud_of(const std::vector<Eigen::Vector3f>& points) {
  Cloud::Ptr cloud(new Cloud);
  for (const Eigen::Vector3f& p : points) {
    cloud->push_back({p.x(), p.y(), p.z()});
  }
  return cloud;
}

/// Descriptors by which every point finds its match and no other: PCL takes descriptors, not matches.
Features::Ptr numbered(std::size_t count) {
  Features::Ptr features(new Features);
  for (std::size_t i = 0; i < count; ++i) {
    pcl::FPFHSignature33 feature{};
    feature.histogram[0] = static_cast<float>(i);
    features->push_back(feature);
  }
  return features;
}

Pose prerejective(const estimation::PointPairs& pairs) {
  pcl::SampleConsensusPrerejective<pcl::PointXYZ, pcl::PointXYZ, pcl::FPFHSignature33> estimator;
  estimator.setInputSource(cloud_of(pairs.source));
  estimator.setSourceFeatures(numbered(pairs.size()));
  estimator.setInputTarget(cloud_of(pairs.target));
  estimator.setTargetFeatures(numbered(pairs.size()));
  estimator.setMaximumIterations(50000);
  estimator.setNumberOfSamples(3);
  estimator.setCorrespondenceRandomness(1);
  estimator.setSimilarityThreshold(0.9F);
  estimator.setMaxCorrespondenceDistance(0.6);
  estimator.setInlierFraction(0.01F);
  Cloud aligned;
  estimator.align(aligned);
  Pose T = Pose::Identity();
  T.matrix() = estimator.getFinalTransformation().cast<double>();
  return T;
}

}  // namespace

std::vector<NamedEstimator> pcl_estimators() { return {{"PCL prerejective", prerejective}}; }

}  // namespace loopmark::benchmarks
#else
namespace loopmark::benchmarks {
std::vector<NamedEstimator> pcl_estimators() { return {}; }
}  // namespace loopmark::benchmarks
#endif
