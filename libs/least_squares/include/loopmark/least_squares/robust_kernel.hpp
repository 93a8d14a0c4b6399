// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace loopmark::least_squares {

/// Robust kernels of iteratively reweighted least squares.
enum class RobustKernel { kNone, kHuber, kCauchy, kGemanMcClure, kTukey, kTruncated };

/// Weight of a residual of squared length r2 under a kernel of scale s (same unit as the residual): the derivative of
/// the loss rho(r^2) with respect to r^2, 1 at zero.
inline double robust_weight(RobustKernel kernel, double r2, double s) {
  const double s2 = s * s;
  switch (kernel) {
    case RobustKernel::kNone:
      return 1.0;
    case RobustKernel::kHuber:
      return r2 <= s2 ? 1.0 : s / std::sqrt(r2);
    case RobustKernel::kCauchy:
      return s2 / (s2 + r2);
    case RobustKernel::kGemanMcClure: {
      const double w = s2 / (s2 + r2);
      return w * w;
    }
    case RobustKernel::kTukey: {
      const double u = std::max(0.0, 1.0 - r2 / s2);
      return u * u;
    }
    case RobustKernel::kTruncated:
      return r2 <= s2 ? 1.0 : 0.0;
  }
  return 1.0;
}

/// The loss rho(r^2) whose derivative is robust_weight; rho(0) = 0.
inline double robust_loss(RobustKernel kernel, double r2, double s) {
  const double s2 = s * s;
  switch (kernel) {
    case RobustKernel::kNone:
      return r2;
    case RobustKernel::kHuber:
      return r2 <= s2 ? r2 : 2.0 * s * std::sqrt(r2) - s2;
    case RobustKernel::kCauchy:
      return s2 * std::log1p(r2 / s2);
    case RobustKernel::kGemanMcClure:
      return s2 * r2 / (s2 + r2);
    case RobustKernel::kTukey: {
      const double u = std::max(0.0, 1.0 - r2 / s2);
      return s2 / 3.0 * (1.0 - u * u * u);
    }
    case RobustKernel::kTruncated:
      return std::min(r2, s2);
  }
  return r2;
}

}  // namespace loopmark::least_squares
