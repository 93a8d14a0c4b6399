// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A cloud for descriptor tests: rough ground, walls, a pole, a ball.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "loopmark/core/random.hpp"

namespace loopmark::testing_support {

inline std::vector<Eigen::Vector3f> rough_yard(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = rng.uniform(-8.0, 8.0);
    const double v = rng.uniform(-8.0, 8.0);
    const double a = rng.uniform(0.0, 2.0 * M_PI);
    Eigen::Vector3d p;
    switch (rng.below(5)) {
      case 0:
      case 1:
        p = {u, v, -1.7 + 0.1 * std::sin(u)};
        break;
      case 2:
        p = {u, 8.0, 0.3 * v};
        break;
      case 3:
        p = {5.0 + 0.3 * std::cos(a), 2.0 + 0.3 * std::sin(a), 0.2 * v};
        break;
      default:
        p = Eigen::Vector3d(-4, -3, 0) + 1.2 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    }
    points.push_back((p + 0.02 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal())).cast<float>());
  }
  return points;
}

}  // namespace loopmark::testing_support
