// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::simulation {

/// What a surface is made of; decides how much of a beam comes back (sensor.hpp).
enum class Material : std::uint8_t {
  kAsphalt,
  kPaving,
  kGrass,
  kBrick,
  kPlaster,
  kConcrete,
  kRoof,
  kGlass,
  kMetal,
  kPaint,
  kRubber,
  kBark,
  kLeaf,
  kCloth,
  kSign,
  kWood,
  kWater,
  kCount
};

/// A material and how light this segment of it is: 0 the darkest, 255 the lightest of its kind.
struct Surface {
  Material material = Material::kConcrete;
  std::uint8_t shade = 128;
};

/// Triangles, each with its surface. Coordinates in metres, z up.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Surface> surfaces;  ///< one a triangle

  std::size_t size() const { return triangles.size(); }
};

/// Adds all of `part`, moved by T_whole_part.
void append(Mesh& whole, const Mesh& part, const Pose& T_whole_part);

void add_triangle(Mesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                  Surface surface);

/// Two triangles a b c, a c d.
void add_quad(Mesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
              const Eigen::Vector3d& d, Surface surface);

/// The six sides of a box with the given corners in the frame of T_mesh_box.
void add_box(Mesh& mesh, const Pose& T_mesh_box, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
             Surface surface);

/// A tapered prism of `sides` sides from `foot` to `top` (a pole, a trunk, a branch), with a lid at the top.
void add_column(Mesh& mesh, const Eigen::Vector3d& foot, const Eigen::Vector3d& top, double foot_radius,
                double top_radius, int sides, Surface surface);

/// A convex outline in the x-z plane pushed along y from y0 to y1, both ends closed; `inset` moves the points of
/// the y ends inwards by that many metres above height `inset_above` (the tumblehome of a car's cabin).
struct Extrusion {
  std::vector<Eigen::Vector2d> outline;  ///< (x, z), counter-clockwise seen from -y
  double y0 = 0.0;
  double y1 = 1.0;
  double inset = 0.0;
  double inset_above = 1e9;
};
void add_extrusion(Mesh& mesh, const Pose& T_mesh_part, const Extrusion& part, Surface surface);

}  // namespace loopmark::simulation
