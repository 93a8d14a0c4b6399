// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "loopmark/core/parallel.hpp"
#include "loopmark/search/kd_tree.hpp"
#include "neighbourhood.hpp"

namespace loopmark::features {
namespace {

constexpr std::size_t kCellsPerTask = 64;
constexpr std::size_t kPointsPerTask = 256;

void set_normal(const internal::Moments& m, const Eigen::Vector3f& point, const Eigen::Vector3f& sensor,
                const NormalOptions& options, std::size_t i, Normals& normals) {
  const double n = m[0];
  if (n < static_cast<double>(options.min_neighbours)) {
    return;
  }
  const Eigen::Vector3d mean = Eigen::Vector3d(m[1], m[2], m[3]) / n;
  Eigen::Matrix3d covariance;
  covariance << m[4], m[5], m[6], m[5], m[7], m[8], m[6], m[8], m[9];
  covariance = (covariance / n - mean * mean.transpose()).eval();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d values = solver.eigenvalues().cwiseMax(0.0);
  Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
  if (!(values.sum() > 0.0) || !normal.allFinite() || normal.norm() < 0.5F) {
    return;
  }
  normal.normalize();
  normals.vectors[i] = normal.dot(sensor - point) < 0.0F ? Eigen::Vector3f(-normal) : normal;
  normals.curvature[i] = static_cast<float>(values[0] / values.sum());
}

void by_radius(const std::vector<Eigen::Vector3f>& points, const NormalOptions& options, const Eigen::Vector3f& sensor,
               Normals& normals) {
  const auto radius = static_cast<float>(options.radius_m);
  const search::CellGrid grid(points, radius * 1.0001F);
  parallel_blocks(grid.cells().size(), kCellsPerTask, [&](std::size_t begin, std::size_t end) {
    internal::Neighbourhood around;
    for (std::size_t c = begin; c < end; ++c) {
      const search::CellGrid::Cell& cell = grid.cells()[c];
      around.gather(grid, cell);
      for (std::uint32_t i = cell.run.begin; i < cell.run.end; ++i) {
        const Eigen::Vector3f point = grid.point(i);
        const internal::Moments moments =
            internal::moments_within(around.x.data(), around.y.data(), around.z.data(), around.x.size(), point.x(),
                                     point.y(), point.z(), radius * radius);
        set_normal(moments, point, sensor, options, grid.index()[i], normals);
      }
    }
  });
}

void by_count(const std::vector<Eigen::Vector3f>& points, const NormalOptions& options, const Eigen::Vector3f& sensor,
              Normals& normals) {
  std::vector<Eigen::Vector3f> finite;
  std::vector<std::size_t> original;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) {
      finite.push_back(points[i]);
      original.push_back(i);
    }
  }
  const search::KdTree tree(finite);
  parallel_for(
      finite.size(),
      [&](std::size_t i) {
        internal::Moments m{};
        for (const search::Neighbour& neighbour : tree.k_nearest(finite[i], options.neighbours)) {
          const Eigen::Vector3f d = finite[neighbour.index] - finite[i];
          const internal::Moments one{1,
                                      d.x(),
                                      d.y(),
                                      d.z(),
                                      d.x() * d.x(),
                                      d.x() * d.y(),
                                      d.x() * d.z(),
                                      d.y() * d.y(),
                                      d.y() * d.z(),
                                      d.z() * d.z()};
          for (std::size_t k = 0; k < m.size(); ++k) {
            m[k] += one[k];
          }
        }
        set_normal(m, finite[i], sensor, options, original[i], normals);
      },
      kPointsPerTask);
}

}  // namespace

Normals estimate_normals(const std::vector<Eigen::Vector3f>& points, const NormalOptions& options,
                         const Eigen::Vector3f& sensor) {
  check(options);
  Normals normals;
  normals.vectors.assign(points.size(), Eigen::Vector3f::Zero());
  normals.curvature.assign(points.size(), 0.0F);
  if (options.neighbours > 0) {
    by_count(points, options, sensor, normals);
  } else {
    by_radius(points, options, sensor, normals);
  }
  return normals;
}

}  // namespace loopmark::features
