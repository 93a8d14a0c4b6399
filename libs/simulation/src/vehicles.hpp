// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/core/random.hpp"
#include "loopmark/simulation/mesh.hpp"

namespace loopmark::simulation::internal {

enum class VehicleKind : std::uint8_t { kHatchback, kSaloon, kEstate, kVan, kTruck, kBus, kCount };

/// Length and width of the kind, metres.
Eigen::Vector2d vehicle_size(VehicleKind kind);

/// A road vehicle; origin on the ground below its middle, x forward.
Mesh make_vehicle(VehicleKind kind, std::uint8_t shade);

/// A walking person; origin on the ground, x forward; `stride` in [0, 1] opens the legs.
Mesh make_pedestrian(double height, double stride);

}  // namespace loopmark::simulation::internal
