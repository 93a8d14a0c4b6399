// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vehicles.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace loopmark::simulation::internal {
namespace {

struct VehicleShape {
  double length, width;
  std::vector<Eigen::Vector2d> body;   ///< side view (x, z), lower part, convex
  std::vector<Eigen::Vector2d> cabin;  ///< side view of the glazed part, convex; may be empty
  double wheel_radius;
  double wheel_x;  ///< of the axles, from the middle
};

VehicleShape car_shape(double length, double rear_slope, double height) {
  const double h = 0.5 * length;
  VehicleShape s{length, 1.78, {}, {}, 0.31, 0.30 * length};
  s.body = {{-h, 0.35}, {-h + 0.12, 0.22}, {h - 0.12, 0.22}, {h, 0.38}, {h, 0.62}, {h - 0.85, 0.88}, {-h, 0.92}};
  s.cabin = {
      {-h + 0.05 + rear_slope * 0.3, 0.88}, {h - 1.15, 0.86}, {h - 1.95, height}, {-h + 0.25 + rear_slope, height}};
  return s;
}

VehicleShape shape_of(VehicleKind kind) {
  switch (kind) {
    case VehicleKind::kHatchback:
      return car_shape(4.0, 0.35, 1.47);
    case VehicleKind::kSaloon:
      return car_shape(4.7, 1.25, 1.45);
    case VehicleKind::kEstate:
      return car_shape(4.75, 0.25, 1.52);
    case VehicleKind::kVan:
      return {5.3, 1.98, {{-2.65, 0.25}, {2.55, 0.25}, {2.65, 0.9}, {2.2, 1.25}, {1.5, 2.2}, {-2.65, 2.25}},
              {},  0.34, 1.6};
    case VehicleKind::kTruck:
      return {8.2,
              2.45,
              {{-4.1, 0.95}, {2.0, 0.95}, {2.0, 3.4}, {-4.1, 3.4}},
              {{2.2, 0.45}, {4.1, 0.45}, {4.1, 1.4}, {3.8, 2.7}, {2.2, 2.8}},
              0.48,
              2.9};
    case VehicleKind::kBus:
    default:
      return {11.5, 2.5, {{-5.75, 0.35}, {5.6, 0.35}, {5.75, 1.2}, {5.55, 3.0}, {-5.75, 3.0}}, {}, 0.48, 3.3};
  }
}

void add_wheels(Mesh& mesh, const VehicleShape& s) {
  const Surface rubber = {Material::kRubber, 128};
  for (const double x : {-s.wheel_x, s.wheel_x}) {
    for (const double side : {-1.0, 1.0}) {
      const double y = side * 0.5 * s.width;
      add_column(mesh, {x, y - side * 0.22, s.wheel_radius}, {x, y + side * 0.01, s.wheel_radius}, s.wheel_radius,
                 s.wheel_radius, 8, rubber);
    }
  }
}

}  // namespace

Eigen::Vector2d vehicle_size(VehicleKind kind) {
  const VehicleShape s = shape_of(kind);
  return {s.length, s.width};
}

Mesh make_vehicle(VehicleKind kind, std::uint8_t shade) {
  const VehicleShape s = shape_of(kind);
  Mesh mesh;
  const double half = 0.5 * s.width;
  const bool tall = s.cabin.empty() || kind == VehicleKind::kTruck;
  add_extrusion(mesh, Pose::Identity(), {s.body, -half, half, tall ? 0.08 : 0.04, 0.8}, {Material::kPaint, shade});
  if (!s.cabin.empty()) {
    const double inset = kind == VehicleKind::kTruck ? 0.05 : 0.2;
    add_extrusion(mesh, Pose::Identity(), {s.cabin, -half + 0.05, half - 0.05, inset, 1.2},
                  {kind == VehicleKind::kTruck ? Material::kPaint : Material::kGlass, shade});
    // Roof and pillars send the beam back, unlike the panes.
    const Eigen::Vector2d rear = s.cabin.back();
    const Eigen::Vector2d front = s.cabin[s.cabin.size() - 2];
    add_box(mesh, Pose::Identity(), {rear.x(), -half + 0.24, rear.y()}, {front.x(), half - 0.24, rear.y() + 0.03},
            {Material::kPaint, shade});
  }
  for (const double side : {-1.0, 1.0}) {  // mirrors
    const double x = 0.5 * s.length - (kind == VehicleKind::kTruck ? 0.3 : 1.5);
    add_box(mesh, Pose::Identity(), {x - 0.1, side * half + std::min(0.0, side * 0.2), 0.95},
            {x + 0.05, side * half + std::max(0.0, side * 0.2), 1.12}, {Material::kPaint, shade});
  }
  add_wheels(mesh, s);
  return mesh;
}

Mesh make_pedestrian(double height, double stride) {
  Mesh mesh;
  const Surface cloth = {Material::kCloth, 128};
  const double hip = 0.5 * height;
  const double step = 0.28 * stride;
  add_column(mesh, {step, 0.1, 0.0}, {0.0, 0.09, hip}, 0.07, 0.09, 6, cloth);
  add_column(mesh, {-step, -0.1, 0.0}, {0.0, -0.09, hip}, 0.07, 0.09, 6, cloth);
  add_column(mesh, {0, 0, 0.95 * hip}, {0.03, 0, 0.83 * height}, 0.17, 0.2, 8, cloth);
  add_column(mesh, {0.02, 0.24, 0.8 * height}, {-step, 0.27, 0.45 * height}, 0.055, 0.04, 5, cloth);
  add_column(mesh, {0.02, -0.24, 0.8 * height}, {step, -0.27, 0.45 * height}, 0.055, 0.04, 5, cloth);
  add_column(mesh, {0.03, 0, 0.84 * height}, {0.03, 0, height}, 0.09, 0.08, 7, cloth);
  return mesh;
}

}  // namespace loopmark::simulation::internal
