// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/mesh.hpp"

#include <cmath>
#include <numbers>

namespace loopmark::simulation {
namespace {

std::uint32_t add_vertex(Mesh& mesh, const Eigen::Vector3d& p) {
  mesh.vertices.push_back(p.cast<float>());
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void add_face(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, Surface surface) {
  mesh.triangles.push_back({a, b, c});
  mesh.surfaces.push_back(surface);
}

}  // namespace

void append(Mesh& whole, const Mesh& part, const Pose& T_whole_part) {
  const auto first = static_cast<std::uint32_t>(whole.vertices.size());
  for (const Eigen::Vector3f& vertex : part.vertices) {
    whole.vertices.push_back((T_whole_part * vertex.cast<double>()).cast<float>());
  }
  for (const auto& triangle : part.triangles) {
    whole.triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
  }
  whole.surfaces.insert(whole.surfaces.end(), part.surfaces.begin(), part.surfaces.end());
}

void add_triangle(Mesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                  Surface surface) {
  const std::uint32_t first = add_vertex(mesh, a);
  add_vertex(mesh, b);
  add_vertex(mesh, c);
  add_face(mesh, first, first + 1, first + 2, surface);
}

void add_quad(Mesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
              const Eigen::Vector3d& d, Surface surface) {
  const std::uint32_t first = add_vertex(mesh, a);
  add_vertex(mesh, b);
  add_vertex(mesh, c);
  add_vertex(mesh, d);
  add_face(mesh, first, first + 1, first + 2, surface);
  add_face(mesh, first, first + 2, first + 3, surface);
}

void add_box(Mesh& mesh, const Pose& T_mesh_box, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
             Surface surface) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int corner = 0; corner < 8; ++corner) {
    add_vertex(mesh, T_mesh_box * Eigen::Vector3d((corner & 1) != 0 ? high.x() : low.x(),
                                                  (corner & 2) != 0 ? high.y() : low.y(),
                                                  (corner & 4) != 0 ? high.z() : low.z()));
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides = {
      {{0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}, {4, 5, 7, 6}, {0, 2, 3, 1}}};
  for (const auto& side : kSides) {
    add_face(mesh, first + side[0], first + side[1], first + side[2], surface);
    add_face(mesh, first + side[0], first + side[2], first + side[3], surface);
  }
}

void add_column(Mesh& mesh, const Eigen::Vector3d& foot, const Eigen::Vector3d& top, double foot_radius,
                double top_radius, int sides, Surface surface) {
  const Eigen::Vector3d axis = (top - foot).normalized();
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const Eigen::Vector3d out = std::cos(angle) * u + std::sin(angle) * v;
    add_vertex(mesh, foot + foot_radius * out);
    add_vertex(mesh, top + top_radius * out);
  }
  const std::uint32_t lid = add_vertex(mesh, top);
  for (int i = 0; i < sides; ++i) {
    const auto a = first + 2 * static_cast<std::uint32_t>(i);
    const auto b = first + 2 * static_cast<std::uint32_t>((i + 1) % sides);
    add_face(mesh, a, b, b + 1, surface);
    add_face(mesh, a, b + 1, a + 1, surface);
    add_face(mesh, a + 1, b + 1, lid, surface);
  }
}

void add_extrusion(Mesh& mesh, const Pose& T_mesh_part, const Extrusion& part, Surface surface) {
  const auto point = [&](std::size_t i, bool far_end) {
    const Eigen::Vector2d& p = part.outline[i % part.outline.size()];
    const double inset = p.y() > part.inset_above ? part.inset : 0.0;
    return Eigen::Vector3d(T_mesh_part * Eigen::Vector3d(p.x(), far_end ? part.y1 - inset : part.y0 + inset, p.y()));
  };
  for (std::size_t i = 0; i < part.outline.size(); ++i) {
    add_quad(mesh, point(i, false), point(i + 1, false), point(i + 1, true), point(i, true), surface);
  }
  for (std::size_t i = 1; i + 1 < part.outline.size(); ++i) {
    add_triangle(mesh, point(0, false), point(i, false), point(i + 1, false), surface);
    add_triangle(mesh, point(0, true), point(i + 1, true), point(i, true), surface);
  }
}

}  // namespace loopmark::simulation
