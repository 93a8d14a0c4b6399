// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What one correspondence adds to the sums, for a motion that is updated from the left: T <- exp(xi) * T,
/// xi = [translation; rotation]. `moved`: the source point, moved into the target's frame (minus the centre that the
/// rotation is taken about, where one is used).
#pragma once

#include "loopmark/least_squares/normal_equations.hpp"

namespace loopmark::least_squares {

/// Point to point: cost w * |e|^2, e = moved - target.
void add_point_to_point(NormalEquations<6>& sums, const Eigen::Vector3d& moved, const Eigen::Vector3d& residual,
                        double w);

/// Point to plane: cost w * e^2, e = normal . (moved - target). `arm`: the lever of the rotation, `moved` or, in
/// symmetric ICP, the middle of the two points.
void add_point_to_plane(NormalEquations<6>& sums, const Eigen::Vector3d& arm, const Eigen::Vector3d& normal,
                        double distance, double w);

/// Surface to surface (Generalized-ICP; surfels): cost w * e^T information e, e = moved - target. `information` is
/// symmetric.
void add_generalized(NormalEquations<6>& sums, const Eigen::Vector3d& moved, const Eigen::Vector3d& residual,
                     const Eigen::Matrix3d& information, double w);

}  // namespace loopmark::least_squares
