// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A small yard of planes, sampled at random, as a world for refinement tests.
#pragma once

#include <vector>

#include "loopmark/core/random.hpp"
#include "loopmark/refinement/icp.hpp"

namespace loopmark::testing_support {

/// A rectangle: corner + u * a + v * b, u and v in [0, 1].
struct Patch {
  Eigen::Vector3d corner, a, b;
};

inline std::vector<Patch> yard() {
  return {{{-10, -8, 0}, {20, 0, 0}, {0, 16, 0}}, {{-10, -8, 0}, {20, 0, 0}, {0, 0, 4}},
          {{-10, -8, 0}, {0, 16, 0}, {0, 0, 3}},  {{2, 3, 0}, {3, 1, 0}, {0, 0, 2}},
          {{-5, 2, 0}, {1, 2, 0}, {0, 0, 2.5}},   {{5, -4, 0}, {2, -1.5, 0}, {0, 0, 1.5}},
          {{-4, -5, 1}, {2, 0.5, 0.3}, {0, 2, 1}}};
}

/// A street without end: ground and two walls along x.
inline std::vector<Patch> corridor() {
  return {{{-20, -4, 0}, {40, 0, 0}, {0, 8, 0}},
          {{-20, -4, 0}, {40, 0, 0}, {0, 0, 3}},
          {{-20, 4, 0}, {40, 0, 0}, {0, 0, 3}}};
}

/// `count` points spread over the patches by area, `sigma` metres of noise along the normals.
inline refinement::Surface sample(const std::vector<Patch>& patches, std::size_t count, double sigma,
                                  std::uint64_t seed) {
  std::vector<double> until;
  double area = 0.0;
  for (const Patch& patch : patches) {
    area += patch.a.cross(patch.b).norm();
    until.push_back(area);
  }
  Rng rng(seed);
  refinement::Surface surface;
  for (std::size_t i = 0; i < count; ++i) {
    const double pick = rng.uniform() * area;
    std::size_t k = 0;
    while (until[k] < pick) {
      ++k;
    }
    const Patch& patch = patches[k];
    const Eigen::Vector3d normal = patch.a.cross(patch.b).normalized();
    const double u = rng.uniform();
    const double v = rng.uniform();
    surface.points.push_back((patch.corner + u * patch.a + v * patch.b + sigma * rng.normal() * normal).cast<float>());
    surface.normals.push_back(normal.cast<float>());
  }
  return surface;
}

inline refinement::Surface moved(const refinement::Surface& surface, const Pose& T) {
  refinement::Surface out = surface;
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    out.points[i] = (T * surface.points[i].cast<double>()).cast<float>();
    out.normals[i] = (T.linear() * surface.normals[i].cast<double>()).cast<float>();
  }
  return out;
}

inline Pose small_motion(double metres, double degrees, std::uint64_t seed) {
  Rng rng(seed);
  Vector6d xi;
  for (int i = 0; i < 6; ++i) {
    xi[i] = rng.normal();
  }
  xi.head<3>() *= metres / xi.head<3>().norm();
  xi.tail<3>() *= degrees * M_PI / 180.0 / xi.tail<3>().norm();
  return exp_se3(xi);
}

}  // namespace loopmark::testing_support
