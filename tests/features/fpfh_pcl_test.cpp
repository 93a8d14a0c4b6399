// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The descriptors are PCL's. Built only where PCL is installed.
#ifdef LOOPMARK_HAVE_PCL

#include <gtest/gtest.h>
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>

#include "loopmark/features/fpfh.hpp"
#include "loopmark/features/normals.hpp"
#include "rough_yard.hpp"

namespace loopmark::features {
namespace {

struct PclCloud {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points{new pcl::PointCloud<pcl::PointXYZ>};
  pcl::PointCloud<pcl::Normal>::Ptr normals{new pcl::PointCloud<pcl::Normal>};
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree{new pcl::search::KdTree<pcl::PointXYZ>};
};

PclCloud to_pcl(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals) {
  PclCloud cloud;
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud.points->push_back({points[i].x(), points[i].y(), points[i].z()});
    cloud.normals->push_back({normals[i].x(), normals[i].y(), normals[i].z()});
  }
  return cloud;
}

TEST(FpfhPcl, CosineOfNearlyAllDescriptorsIsOne) {
  const auto points = testing_support::rough_yard(4000, 1);
  NormalOptions normal_options;
  normal_options.min_neighbours = 3;
  const auto normals = estimate_normals(points, normal_options).vectors;
  FpfhOptions options;
  options.radius_m = 2.0;
  const search::DescriptorMatrix ours = fpfh(points, normals, options);

  const PclCloud cloud = to_pcl(points, normals);
  pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(cloud.points);
  estimation.setInputNormals(cloud.normals);
  estimation.setSearchMethod(cloud.tree);
  estimation.setRadiusSearch(options.radius_m);
  pcl::PointCloud<pcl::FPFHSignature33> theirs;
  estimation.compute(theirs);
  std::size_t same = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Map<const Eigen::RowVectorXf> expected(theirs[i].histogram, kFpfhDimension);
    same += ours.row(static_cast<Eigen::Index>(i)).normalized().dot(expected.normalized()) >= 0.99F ? 1U : 0U;
  }
  EXPECT_GE(same, points.size() * 99 / 100);
}

TEST(FpfhPcl, NormalsAgree) {
  const auto points = testing_support::rough_yard(3000, 2);
  NormalOptions options;
  options.radius_m = 1.0;
  const auto ours = estimate_normals(points, options).vectors;
  const PclCloud cloud = to_pcl(points, ours);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud.points);
  estimation.setSearchMethod(cloud.tree);
  estimation.setRadiusSearch(options.radius_m);
  pcl::PointCloud<pcl::Normal> theirs;
  estimation.compute(theirs);
  std::size_t same = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    same += ours[i].dot(theirs[i].getNormalVector3fMap()) > 0.999F ? 1U : 0U;
  }
  EXPECT_GE(same, points.size() * 99 / 100);
}

}  // namespace
}  // namespace loopmark::features

#endif  // LOOPMARK_HAVE_PCL
