// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "peers.hpp"

#ifdef LOOPMARK_HAVE_PCL
#include <pcl/features/fpfh_omp.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/ndt.h>
#include <pcl/registration/sample_consensus_prerejective.h>

namespace loopmark::benchmarks {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;
using Tree = pcl::search::KdTree<pcl::PointXYZ>;

struct Scan {
  Cloud::Ptr cloud{new Cloud};
  Features::Ptr features{new Features};
};

PeerLibrary::Scan prepare(const std::vector<Eigen::Vector3f>& points) {
  Cloud::Ptr raw(new Cloud);
  for (const Eigen::Vector3f& p : points) {
    raw->push_back({p.x(), p.y(), p.z()});
  }
  const auto scan = std::make_shared<Scan>();
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(raw);
  grid.setLeafSize(0.3F, 0.3F, 0.3F);
  grid.filter(*scan->cloud);
  pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> normal_estimation;
  normal_estimation.setInputCloud(scan->cloud);
  normal_estimation.setSearchMethod(Tree::Ptr(new Tree));
  normal_estimation.setRadiusSearch(1.2);
  normal_estimation.compute(*normals);
  pcl::FPFHEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(scan->cloud);
  estimation.setInputNormals(normals);
  estimation.setSearchMethod(Tree::Ptr(new Tree));
  estimation.setRadiusSearch(2.4);
  estimation.compute(*scan->features);
  // Points without a normal have no descriptor; they would stop the search for neighbours.
  Scan kept;
  for (std::size_t i = 0; i < scan->cloud->size(); ++i) {
    const float* histogram = scan->features->at(i).histogram;
    if (std::all_of(histogram, histogram + 33, [](float value) { return std::isfinite(value); })) {
      kept.cloud->push_back(scan->cloud->at(i));
      kept.features->push_back(scan->features->at(i));
    }
  }
  return std::make_shared<Scan>(kept);
}

const Scan& scan_of(const void* prepared) { return *static_cast<const Scan*>(prepared); }

Pose pose_of(const Eigen::Matrix4f& matrix) {
  Pose T = Pose::Identity();
  T.matrix() = matrix.cast<double>();
  T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return T;
}

std::optional<Pose> prerejective(const void* source, const void* target) {
  pcl::SampleConsensusPrerejective<pcl::PointXYZ, pcl::PointXYZ, pcl::FPFHSignature33> estimator;
  estimator.setInputSource(scan_of(source).cloud);
  estimator.setSourceFeatures(scan_of(source).features);
  estimator.setInputTarget(scan_of(target).cloud);
  estimator.setTargetFeatures(scan_of(target).features);
  estimator.setMaximumIterations(50000);
  estimator.setNumberOfSamples(3);
  estimator.setCorrespondenceRandomness(2);
  estimator.setSimilarityThreshold(0.9F);
  estimator.setMaxCorrespondenceDistance(0.6);
  estimator.setInlierFraction(0.25F);
  Cloud aligned;
  estimator.align(aligned);
  return estimator.hasConverged() ? std::optional(pose_of(estimator.getFinalTransformation())) : std::nullopt;
}

Pose gicp(const void* source, const void* target, const Pose& start) {
  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> refinement;
  refinement.setInputSource(scan_of(source).cloud);
  refinement.setInputTarget(scan_of(target).cloud);
  refinement.setMaxCorrespondenceDistance(0.6);
  refinement.setMaximumIterations(30);
  Cloud aligned;
  refinement.align(aligned, start.matrix().cast<float>());
  return pose_of(refinement.getFinalTransformation());
}

Pose ndt(const void* source, const void* target, const Pose& start) {
  pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> refinement;
  refinement.setInputSource(scan_of(source).cloud);
  refinement.setInputTarget(scan_of(target).cloud);
  refinement.setResolution(1.0F);
  refinement.setStepSize(0.1);
  refinement.setTransformationEpsilon(0.01);
  refinement.setMaximumIterations(30);
  Cloud aligned;
  refinement.align(aligned, start.matrix().cast<float>());
  return pose_of(refinement.getFinalTransformation());
}

}  // namespace

std::optional<PeerLibrary> pcl_library() {
  return PeerLibrary{"pcl", prepare, {{"pcl-prerejective", prerejective}}, {{"pcl-gicp", gicp}, {"pcl-ndt", ndt}}};
}

}  // namespace loopmark::benchmarks
#else
namespace loopmark::benchmarks {
std::optional<PeerLibrary> pcl_library() { return std::nullopt; }
}  // namespace loopmark::benchmarks
#endif
