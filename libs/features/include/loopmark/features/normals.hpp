// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "loopmark/core/options.hpp"

namespace loopmark::features {

struct NormalOptions {
  double radius_m = 1.2;
  std::size_t neighbours = 0;
  std::size_t min_neighbours = 5;
};

template <class Visitor>
void describe(Visitor& v, NormalOptions& o) {
  v.field("radius_m", o.radius_m, "neighbours within this distance make the normal, metres");
  v.field("neighbours", o.neighbours, "use this many nearest neighbours instead of a radius; 0: the radius");
  v.field("min_neighbours", o.min_neighbours, "points with fewer (themselves included) get no normal");
}

inline void check(const NormalOptions& o) {
  require_option(o.neighbours > 0 || o.radius_m > 0, "radius_m", "must be larger than 0");
  require_option(o.min_neighbours >= 3, "min_neighbours", "must be 3 or more");
}

/// Normals of a cloud, one a point.
struct Normals {
  std::vector<Eigen::Vector3f> vectors;  ///< unit length, towards the sensor; zero where there is none
  std::vector<float> curvature;          ///< least eigenvalue over the sum of all three: 0 flat, 1/3 a ball
};

/// The direction of least spread of each point's neighbours (principal component analysis), turned towards `sensor`
/// (in the frame of the points, metres). Points that are not finite get none.
Normals estimate_normals(const std::vector<Eigen::Vector3f>& points, const NormalOptions& options,
                         const Eigen::Vector3f& sensor = Eigen::Vector3f::Zero());

}  // namespace loopmark::features
