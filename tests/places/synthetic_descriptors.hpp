// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Descriptors as a drive gives them, without the scans: slowly changing, positive, of length 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "loopmark/core/random.hpp"
#include "loopmark/places/place_descriptor.hpp"

namespace loopmark::testing {

inline void normalise(places::PlaceDescriptor& descriptor) {
  double sum = 0.0;
  for (float& v : descriptor.values) {
    v = std::max(v, 0.0F);
    sum += static_cast<double>(v) * static_cast<double>(v);
  }
  for (float& v : descriptor.values) {
    v = static_cast<float>(static_cast<double>(v) / std::sqrt(sum));
  }
}

/// A first-order autoregressive walk around a common mean profile; neighbours correlate with 0.95.
inline std::vector<places::PlaceDescriptor> drive_descriptors(std::size_t count, std::uint64_t seed,
                                                              std::size_t size = 512) {
  Rng rng(seed);
  std::vector<float> state(size, 0.0F);
  std::vector<places::PlaceDescriptor> drive(count);
  for (places::PlaceDescriptor& descriptor : drive) {
    descriptor.values.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      state[i] = 0.95F * state[i] + 0.31F * static_cast<float>(rng.normal());
      descriptor.values[i] = 2.0F + state[i];
    }
    normalise(descriptor);
  }
  return drive;
}

/// The same place on another day: a third of the difference between places.
inline places::PlaceDescriptor seen_again(const places::PlaceDescriptor& descriptor, std::uint64_t seed) {
  Rng rng(seed);
  places::PlaceDescriptor again = descriptor;
  const double scale = 0.33 / std::sqrt(5.0 * static_cast<double>(descriptor.values.size()));
  for (float& v : again.values) {
    v += static_cast<float>(scale * rng.normal());
  }
  normalise(again);
  return again;
}

}  // namespace loopmark::testing
