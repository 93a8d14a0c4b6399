// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "polar_histogram_kernels.hpp"

#include <cmath>

#include "loopmark/core/dispatch.hpp"

namespace loopmark::shape_context::internal {
namespace {

constexpr float kHalfPi = 1.57079633F;
constexpr float kPi = 3.14159265F;
constexpr float kSectorsPerRadian = static_cast<float>(kSectors) / (2.0F * kPi);
constexpr float kLastSector = static_cast<float>(kSectors) - 1e-4F;

}  // namespace

LOOPMARK_DISPATCH
void polar_places(const float* dx, const float* dy, std::size_t count, float radius, float* __restrict ring,
                  float* __restrict sector) {
  const float inverse = 1.0F / (radius * radius);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = dx[i];
    const float y = dy[i];
    const float share = std::sqrt((x * x + y * y) * inverse);  // d / R
    const float root = std::sqrt(share);
    const float place = static_cast<float>(kRings) * root * std::sqrt(root);
    const float beyond = (place < static_cast<float>(kRings) ? place : static_cast<float>(kRings)) + 0.5F;
    ring[i] = place < 0.5F ? place + place : beyond;
    // atan2 by a minimax polynomial of atan on [0, 1] (Abramowitz and Stegun 4.4.49).
    const float ax = x < 0.0F ? -x : x;
    const float ay = y < 0.0F ? -y : y;
    const float low = ax < ay ? ax : ay;
    const float high = ax < ay ? ay : ax;
    const float t = low / (high + 1e-20F);
    const float t2 = t * t;
    float angle = t * (0.9998660F + t2 * (-0.3302995F + t2 * (0.1801410F + t2 * (-0.0851330F + t2 * 0.0208351F))));
    angle = ax < ay ? kHalfPi - angle : angle;
    angle = x < 0.0F ? kPi - angle : angle;
    angle = y < 0.0F ? kPi + kPi - angle : angle;
    const float at = angle * kSectorsPerRadian;
    sector[i] = at < kLastSector ? at : kLastSector;
  }
}

}  // namespace loopmark::shape_context::internal
