// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Local registration: from a motion that is roughly right to an accurate one (paper, appendix "Local Registration").
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/least_squares/pair_equations.hpp"
#include "loopmark/refinement/icp_options.hpp"
#include "loopmark/search/cell_grid.hpp"

namespace loopmark::refinement {

/// Points (metres) and their unit normals; normals are empty where the metric needs none.
struct Surface {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
};

/// A target made ready for searching, once for many refinements.
class IcpTarget {
 public:
  /// Searches are fastest with the max_distance_m given here, and right with any other.
  IcpTarget(const Surface& surface, double max_distance_m);

  const search::CellGrid& grid() const { return grid_; }
  bool has_normals() const { return !normals_.empty(); }
  /// Normal of the point at a sorted place of the grid.
  const Eigen::Vector3f& normal(std::uint32_t place) const { return normals_[place]; }

 private:
  search::CellGrid grid_;
  std::vector<Eigen::Vector3f> normals_;
};

enum class IcpStop { kConverged, kIterationLimit, kTooFewPairs };
const char* to_string(IcpStop stop);

/// The outcome of a refinement, with what is needed to judge it.
struct IcpResult {
  Pose T_target_source = Pose::Identity();
  bool converged = false;
  IcpStop stop = IcpStop::kIterationLimit;
  std::size_t iterations = 0;
  std::size_t inliers = 0;                  ///< pairs at the final motion
  double inlier_share = 0.0;                ///< of the source points
  double rms_m = 0.0;                       ///< root-mean-square residual of the metric, metres
  Matrix6d information = Matrix6d::Zero();  ///< of xi in exp(xi) * T_target_source
  Matrix6d covariance = Matrix6d::Zero();   ///< its inverse; wide, not infinite, along free directions
  least_squares::Constraint constraint;     ///< point-to-plane constraint where the target has normals
  int weak_directions = 0;                  ///< directions weaker than the option weak_strength

  /// One line for logs.
  std::string summary() const;
};

/// Refines T_target_source, starting at `initial`. The covariance is that of the least-squares problem at the
/// solution (residual variance times inverse Hessian), for residuals that are independent of each other.
/// Throws std::invalid_argument where the metric needs normals that are not there.
IcpResult icp(const Surface& source, const IcpTarget& target, const Pose& initial, const IcpOptions& options = {});

}  // namespace loopmark::refinement
