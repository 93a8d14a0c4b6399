// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/core/pose.hpp"

namespace loopmark::pose_graph::internal {

/// Inverse of the left Jacobian of SE(3) at xi = [rho; phi]: log(exp(d) * exp(xi)) = xi + J * d to first order.
/// The inverse of the right Jacobian at xi is the same function at -xi.
/// (Barfoot, State Estimation for Robotics, eq. 7.85 and 7.95.)
Matrix6d left_jacobian_inverse(const Vector6d& xi);

}  // namespace loopmark::pose_graph::internal
