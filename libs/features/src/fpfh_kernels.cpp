// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "fpfh_kernels.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/core/dispatch.hpp"

namespace loopmark::features::internal {
namespace {

constexpr float kPi = 3.14159265358979F;

/// atan2 without branches, within 1e-5 rad: far finer than a bin of 0.57 rad.
inline float fast_atan2(float y, float x) {
  const float ax = std::fabs(x);
  const float ay = std::fabs(y);
  const float large = ax > ay ? ax : ay;
  const float small = ax > ay ? ay : ax;
  const float a = small / (large > 1e-30F ? large : 1e-30F);
  const float s = a * a;
  float r = a * (0.99997726F +
                 s * (-0.33262347F + s * (0.19354346F + s * (-0.11643287F + s * (0.05265332F - s * 0.01172120F)))));
  r = ay > ax ? 0.5F * kPi - r : r;
  r = x < 0.0F ? kPi - r : r;
  return y < 0.0F ? -r : r;
}

inline std::uint8_t bin_of(float unit) {
  float b = unit * static_cast<float>(kFpfhBins);
  b = b > 0.0F ? b : 0.0F;
  b = b < 10.0F ? b : 10.0F;
  return static_cast<std::uint8_t>(static_cast<std::int32_t>(b));
}

}  // namespace

LOOPMARK_DISPATCH
void squared_distances(const float* x, const float* y, const float* z, std::size_t count, const float q[3],
                       float* squared) {
  const float qx = q[0];
  const float qy = q[1];
  const float qz = q[2];
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = x[i] - qx;
    const float dy = y[i] - qy;
    const float dz = z[i] - qz;
    squared[i] = dx * dx + dy * dy + dz * dz;
  }
}

LOOPMARK_DISPATCH
void pair_bins(const OrientedPoint& point, const NeighbourArrays& to, std::size_t count, std::uint8_t* __restrict theta,
               std::uint8_t* __restrict alpha, std::uint8_t* __restrict phi) {
  const float px = point.p[0], py = point.p[1], pz = point.p[2];
  const float ux = point.n[0], uy = point.n[1], uz = point.n[2];
  const float *tx = to.x, *ty = to.y, *tz = to.z, *tnx = to.nx, *tny = to.ny, *tnz = to.nz, *t2 = to.squared;
  for (std::size_t k = 0; k < count; ++k) {
    const float inverse = 1.0F / std::sqrt(t2[k]);
    const float dx = (tx[k] - px) * inverse;
    const float dy = (ty[k] - py) * inverse;
    const float dz = (tz[k] - pz) * inverse;
    const float wx = tnx[k], wy = tny[k], wz = tnz[k];
    const float angle1 = ux * dx + uy * dy + uz * dz;
    const float angle2 = wx * dx + wy * dy + wz * dz;
    // The Darboux frame stands on the point whose normal is closer to the line between the two.
    const bool swap = std::fabs(angle1) < std::fabs(angle2);
    const float sign = swap ? -1.0F : 1.0F;
    const float ax = swap ? wx : ux, ay = swap ? wy : uy, az = swap ? wz : uz;
    const float bx = swap ? ux : wx, by = swap ? uy : wy, bz = swap ? uz : wz;
    const float f3 = swap ? -angle2 : angle1;
    float vx = sign * (dy * az - dz * ay);
    float vy = sign * (dz * ax - dx * az);
    float vz = sign * (dx * ay - dy * ax);
    const float v2 = vx * vx + vy * vy + vz * vz;
    const bool valid = v2 > 1e-14F && (wx * wx + wy * wy + wz * wz) > 0.5F;
    const float scale = 1.0F / std::sqrt(valid ? v2 : 1.0F);
    vx *= scale;
    vy *= scale;
    vz *= scale;
    const float f2 = vx * bx + vy * by + vz * bz;
    const float sx = ay * vz - az * vy;
    const float sy = az * vx - ax * vz;
    const float sz = ax * vy - ay * vx;
    const float f1 = fast_atan2(sx * bx + sy * by + sz * bz, ax * bx + ay * by + az * bz);
    theta[k] = valid ? bin_of((f1 + kPi) * (0.5F / kPi)) : kNoBin;
    alpha[k] = valid ? bin_of((f2 + 1.0F) * 0.5F) : kNoBin;
    phi[k] = valid ? bin_of((f3 + 1.0F) * 0.5F) : kNoBin;
  }
}

LOOPMARK_DISPATCH
void weighted_sum(const float* rows, const std::uint32_t* row, const float* weight, std::size_t count,
                  float sum[kFpfhRow]) {
  using Vector = float __attribute__((vector_size(32), aligned(4)));
  static_assert(kFpfhRow == 5 * 8);
  Vector s0{}, s1{}, s2{}, s3{}, s4{};
  for (std::size_t k = 0; k < count; ++k) {
    const auto* r = reinterpret_cast<const Vector*>(rows + kFpfhRow * row[k]);
    const float w = weight[k];
    s0 += w * r[0];
    s1 += w * r[1];
    s2 += w * r[2];
    s3 += w * r[3];
    s4 += w * r[4];
  }
  auto* out = reinterpret_cast<Vector*>(sum);
  out[0] = s0;
  out[1] = s1;
  out[2] = s2;
  out[3] = s3;
  out[4] = s4;
}

}  // namespace loopmark::features::internal
