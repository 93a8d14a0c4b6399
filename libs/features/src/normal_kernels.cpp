// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "normal_kernels.hpp"

#include "loopmark/core/dispatch.hpp"

namespace loopmark::features::internal {
namespace {

LOOPMARK_DISPATCH
void add_moments(const float* x, const float* y, const float* z, std::size_t count, float qx, float qy, float qz,
                 float squared_radius, float (*sums)[kLanes]) {
  for (std::size_t begin = 0; begin < count; begin += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float dx = x[begin + l] - qx;
      const float dy = y[begin + l] - qy;
      const float dz = z[begin + l] - qz;
      const float in = dx * dx + dy * dy + dz * dz < squared_radius ? 1.0F : 0.0F;
      const float mx = in * dx;
      const float my = in * dy;
      const float mz = in * dz;
      sums[0][l] += in;
      sums[1][l] += mx;
      sums[2][l] += my;
      sums[3][l] += mz;
      sums[4][l] += mx * dx;
      sums[5][l] += mx * dy;
      sums[6][l] += mx * dz;
      sums[7][l] += my * dy;
      sums[8][l] += my * dz;
      sums[9][l] += mz * dz;
    }
  }
}

}  // namespace

Moments moments_within(const float* x, const float* y, const float* z, std::size_t count, float qx, float qy, float qz,
                       float squared_radius) {
  float sums[10][kLanes] = {};
  add_moments(x, y, z, count, qx, qy, qz, squared_radius, sums);
  Moments moments{};
  for (std::size_t k = 0; k < moments.size(); ++k) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      moments[k] += sums[k][l];
    }
  }
  return moments;
}

}  // namespace loopmark::features::internal
