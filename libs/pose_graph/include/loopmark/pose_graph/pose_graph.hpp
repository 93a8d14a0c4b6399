// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A graph of poses and relative motions, solved so that a wrong loop does not bend the map.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/pose_graph/pose_graph_options.hpp"

namespace loopmark::pose_graph {

/// Where a constraint comes from decides whether it may be doubted.
enum class EdgeKind {
  kOdometry,  ///< trusted; odometry edges alone define the segments of the graph
  kLoop,      ///< doubted: must agree with the others
  kForced     ///< a loop that somebody vouches for; trusted
};

/// A measured relative motion between two nodes.
struct PoseGraphEdge {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose T_from_to = Pose::Identity();
  /// Inverse covariance of xi in exp(xi) * T_from_to (metres; radians), the convention of RegistrationResult
  /// with from = target and to = source.
  Matrix6d information = Matrix6d::Identity();
  EdgeKind kind = EdgeKind::kOdometry;
};

/// Poses and constraints. Segments (what odometry edges connect) need not share a frame at the start: they are
/// placed by the loops between them, and those that find no place stay where they are.
struct PoseGraph {
  std::vector<Pose> T_map_node;  ///< initial poses; right up to one rigid motion within each segment
  std::vector<PoseGraphEdge> edges;
  std::vector<std::size_t> anchors;  ///< nodes that do not move; empty: node 0
};

/// What became of a constraint, and why.
enum class EdgeVerdict {
  kAccepted,      ///< it holds its share of the map
  kInconsistent,  ///< it contradicts the largest set of loops that agree with one another (PCM)
  kOutlier,       ///< the robust optimisation gave it weight zero (GNC)
  kTooFewLinks    ///< the segments it would join have fewer agreeing links than `min_links`
};

/// "accepted", "inconsistent", "outlier", "too few links".
std::string to_string(EdgeVerdict verdict);

struct EdgeReport {
  EdgeVerdict verdict = EdgeVerdict::kAccepted;
  double weight = 1.0;                   ///< final weight in [0, 1]
  Vector6d residual = Vector6d::Zero();  ///< log(T_map_from^-1 * T_map_to * T_from_to^-1) at the solution
  double chi2 = 0.0;                     ///< residual^T * information * residual
  std::size_t agrees_with = 0;           ///< loops of its group that are pairwise consistent with it
  std::size_t group_size = 0;            ///< loops between the same two segments (or within the same segment)
};

/// Nodes that accepted constraints connect, in increasing order. Poses of different components have nothing
/// to do with one another.
struct PoseGraphComponent {
  std::vector<std::size_t> nodes;
  bool anchored = false;  ///< holds an anchor; else its first node stands for one
};

struct PoseGraphSolution {
  std::vector<Pose> T_map_node;
  std::vector<EdgeReport> edges;               ///< one for each edge of the graph, in order
  std::vector<PoseGraphComponent> components;  ///< anchored ones first, then by first node
  std::vector<std::size_t> component_of;       ///< for each node
  std::size_t robust_steps = 0;                ///< solves done by graduated non-convexity
  std::size_t iterations = 0;                  ///< Levenberg-Marquardt iterations in all
  double initial_cost = 0.0;  ///< half the sum of weighted chi2 of accepted edges, before the last solve
  double final_cost = 0.0;    ///< the same after it
  bool converged = false;     ///< the last solve converged
  std::string message;        ///< one line on how it ended
  double seconds = 0.0;
};

/// Solves the graph: pairwise consistency maximisation over the loops (Mangelson et al., ICRA 2018), placement
/// of the segments, then Levenberg-Marquardt under graduated non-convexity with truncated least squares on the
/// loops (Yang et al., RA-L 2020). One thread: the same bytes every time.
/// Throws InputError naming the edge or node when an index, a pose or an information matrix makes no sense.
PoseGraphSolution optimize(const PoseGraph& graph, const PoseGraphOptions& options = {});

/// Covariance of xi in exp(xi) * T_map_node for each node, given that the anchors (or the first node of a
/// component without one) are exact: those get zero. Metres, radians; from the Gauss-Newton normal
/// equations by the sparse inverse subset (Takahashi et al. 1973).
std::vector<Matrix6d> marginal_covariances(const PoseGraph& graph, const PoseGraphSolution& solution);

/// The covariance as an information matrix, after adding (floor_m, floor_deg) in quadrature: registration
/// covariances count noise only and are too sure of themselves. Directions of infinite or absurd variance
/// get an information near zero. Throws InputError when the covariance is not finite or not symmetric.
Matrix6d information_from_covariance(const Matrix6d& covariance, double floor_m, double floor_deg);

}  // namespace loopmark::pose_graph
