// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loopmark/core/random.hpp"
#include "loopmark/simulation/town.hpp"

namespace loopmark::simulation::internal {

/// A place on a street where a car may be, heading along the street or against it.
struct StreetPlace {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  bool near_identical = false;
};

/// Places all over a town's streets, about two metres apart, in both directions.
class StreetPlaces {
 public:
  explicit StreetPlaces(const Town& town);

  StreetPlace any(Rng& rng) const;
  /// A place between `low` and `high` metres from `p`; the nearest to that when there is none.
  StreetPlace at_distance(const Eigen::Vector2d& p, double low, double high, Rng& rng) const;
  /// A place on a row of alike blocks, and one that looks the same: in the other row, turned by half a turn, or some
  /// blocks on.
  std::pair<StreetPlace, StreetPlace> alike(Rng& rng) const;

 private:
  const Town* town_;
  std::vector<StreetPlace> places_;
};

}  // namespace loopmark::simulation::internal
