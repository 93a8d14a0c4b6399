// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a place looks like from above, as a vector that does not change when the sensor turns or moves a little.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/core/options.hpp"

namespace loopmark::places {

struct PlaceOptions {
  double cell_m = 1.0;         ///< edge of a cell of the bird's-eye view
  double radius_m = 96.0;      ///< what is further from the sensor is left out
  double min_height_m = 1.0;   ///< structure begins there above the ground
  double max_height_m = 3.0;   ///< and ends there: above it, some sensors see crowns and upper floors, others nothing
  std::size_t radii = 32;      ///< frequencies sampled, from long waves to four cells
  std::size_t angles = 64;     ///< directions sampled over half a turn
  std::size_t harmonics = 16;  ///< of each frequency's profile over the directions
};

template <class Visitor>
void describe(Visitor& v, PlaceOptions& o) {
  v.field("cell_m", o.cell_m, "edge of a cell of the bird's-eye view");
  v.field("radius_m", o.radius_m, "what is further from the sensor is left out");
  v.field("min_height_m", o.min_height_m, "structure begins there above the ground");
  v.field("max_height_m", o.max_height_m, "and ends there");
  v.field("radii", o.radii, "frequencies sampled, from long waves to four cells");
  v.field("angles", o.angles, "directions sampled over half a turn");
  v.field("harmonics", o.harmonics, "of each frequency's profile over the directions");
}

/// Throws InputError naming the option whose value makes no sense.
void check(const PlaceOptions& options);

/// A vector of length 1 (radii x harmonics numbers), or all zeros for a scan without structure.
struct PlaceDescriptor {
  std::vector<float> values;

  /// Bytes that from_bytes restores exactly. Throws InputError on bytes that are damaged.
  std::string to_bytes() const;
  /// Whether the bytes were written by an earlier version, which drew places in another way.
  static bool is_outdated(const std::string& bytes);
  static PlaceDescriptor from_bytes(const std::string& bytes);
};

/// Throws InputError unless the descriptor is one that place_descriptor() can give with these options: as many numbers,
/// each from -1 to 1.
void require_sound(const PlaceDescriptor& descriptor, const PlaceOptions& options);

/// Euclidean distance, 0 (alike) to 2. Throws std::invalid_argument when the sizes differ.
double distance(const PlaceDescriptor& a, const PlaceDescriptor& b);

/// The descriptor of a scan whose points stand in a levelled frame (z up, the ground near z = 0; origin at the sensor's
/// foot). The square root of the highest point of each cell makes an image; the magnitude of its spectrum does not
/// change with translation (but for what comes into sight), the magnitude of the harmonics of the spectrum over
/// direction not with yaw. (The idea of RING, Lu et al. 2022, and FreSCo, Fan et al. 2022, without their search.)
PlaceDescriptor place_descriptor(const std::vector<Eigen::Vector3f>& levelled_points, const PlaceOptions& options = {});

}  // namespace loopmark::places
