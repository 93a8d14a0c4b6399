// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "loopmark/simulation/town.hpp"

namespace loopmark::simulation {

/// A ray to cast, and what it met. `range_m` is the reach on entry and the distance of the hit on return.
struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  ///< unit length
  float range_m = 120.0F;
  float moment = 0.5F;  ///< when it is fired: 0 the start, 1 the end of the sweep
  bool hit = false;
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit length, either side
  Surface surface;
};

/// Something that moves during a sweep: one of the world's shapes, and where it is at both ends of the sweep.
struct MovingBody {
  std::size_t shape = 0;
  Pose T_world_body_start = Pose::Identity();
  Pose T_world_body_end = Pose::Identity();
};

/// The shapes that can move: vehicles of several kinds, then people.
struct ShapeList {
  std::vector<Mesh> meshes;
  std::vector<Eigen::Vector2d> sizes;  ///< length, width
  std::size_t vehicles = 0;            ///< the first so many are vehicles
};
ShapeList make_shapes();

/// All that beams can meet on one day: the town with that day's parked cars, and the shapes that move. Casting is
/// thread-safe, and its answers do not depend on the number of threads.
class World {
 public:
  World(const Town& town, int day);
  /// Of a bare mesh, for tests.
  explicit World(const Mesh& mesh);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Bodies placed for one sweep, ready to be met by rays.
  class Moving;
  std::shared_ptr<const Moving> place(const std::vector<MovingBody>& bodies) const;

  /// Finds the nearest hit of each ray among the static mesh and, unless null, the moving bodies.
  void cast(std::vector<Ray>& rays, const Moving* moving) const;

  const ShapeList& shapes() const;
  std::size_t triangles() const;
  int day() const { return day_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  int day_ = 0;
};

}  // namespace loopmark::simulation
