// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "peer_features.hpp"

#ifdef LOOPMARK_HAVE_PCL
#include <pcl/features/fpfh_omp.h>

#include <flann/flann.hpp>

namespace loopmark::benchmarks {

bool peer_fpfh(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals, double radius_m,
               int threads) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::PointCloud<pcl::Normal>::Ptr oriented(new pcl::PointCloud<pcl::Normal>);
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud->push_back({points[i].x(), points[i].y(), points[i].z()});
    oriented->push_back({normals[i].x(), normals[i].y(), normals[i].z()});
  }
  pcl::FPFHEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation(static_cast<unsigned>(threads));
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(oriented);
  estimation.setSearchMethod(pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  estimation.setRadiusSearch(radius_m);
  pcl::PointCloud<pcl::FPFHSignature33> descriptors;
  estimation.compute(descriptors);
  return descriptors.size() == points.size();
}

namespace {

void search(const search::DescriptorMatrix& queries, const search::DescriptorMatrix& in, int threads) {
  // FLANN wants pointers to what it only reads.
  const auto matrix = [](const search::DescriptorMatrix& m) {
    return flann::Matrix<float>(const_cast<float*>(m.data()), static_cast<std::size_t>(m.rows()),
                                static_cast<std::size_t>(m.cols()));
  };
  flann::Index<flann::L2<float>> index(matrix(in), flann::KDTreeSingleIndexParams(15));
  index.buildIndex();
  const auto rows = static_cast<std::size_t>(queries.rows());
  std::vector<int> found(2 * rows);
  std::vector<float> distances(2 * rows);
  flann::Matrix<int> found_matrix(found.data(), rows, 2);
  flann::Matrix<float> distance_matrix(distances.data(), rows, 2);
  flann::SearchParams params(flann::FLANN_CHECKS_UNLIMITED);
  params.cores = threads;
  index.knnSearch(matrix(queries), found_matrix, distance_matrix, 2, params);
}

}  // namespace

bool peer_nearest_two(const search::DescriptorMatrix& source, const search::DescriptorMatrix& target, int threads) {
  search(source, target, threads);
  search(target, source, threads);
  return true;
}

}  // namespace loopmark::benchmarks
#else
namespace loopmark::benchmarks {
bool peer_fpfh(const std::vector<Eigen::Vector3f>&, const std::vector<Eigen::Vector3f>&, double, int) { return false; }
bool peer_nearest_two(const search::DescriptorMatrix&, const search::DescriptorMatrix&, int) { return false; }
}  // namespace loopmark::benchmarks
#endif
