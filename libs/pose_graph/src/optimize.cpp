// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "consistency.hpp"
#include "edge_cost.hpp"
#include "least_squares.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/pose_graph/pose_graph.hpp"
#include "placement.hpp"
#include "segments.hpp"
#include "validate.hpp"

namespace loopmark::pose_graph {
namespace {

using namespace pose_graph;

constexpr std::size_t kRobustStepIterations = 12;
constexpr std::size_t kMaxRobustSteps = 80;
constexpr std::size_t kMaxRounds = 4;

std::vector<double> weights_of(const std::vector<EdgeReport>& reports) {
  std::vector<double> weights;
  weights.reserve(reports.size());
  for (const EdgeReport& report : reports) {
    weights.push_back(report.weight);
  }
  return weights;
}

void measure_residuals(const PoseGraph& graph, const std::vector<Pose>& poses, std::vector<EdgeReport>& reports) {
  for (std::size_t e = 0; e < reports.size(); ++e) {
    const PoseGraphEdge& edge = graph.edges[e];
    reports[e].residual = internal::edge_residual(poses[edge.from], poses[edge.to], edge.T_from_to);
    reports[e].chi2 = reports[e].residual.dot(edge.information * reports[e].residual);
  }
}

bool is_doubted(const PoseGraph& graph, const std::vector<EdgeReport>& reports, std::size_t e) {
  return graph.edges[e].kind == EdgeKind::kLoop && reports[e].verdict == EdgeVerdict::kAccepted;
}

double worst_loop_chi2(const PoseGraph& graph, const std::vector<EdgeReport>& reports) {
  double worst = 0.0;
  for (std::size_t e = 0; e < reports.size(); ++e) {
    if (is_doubted(graph, reports, e)) {
      worst = std::max(worst, reports[e].chi2);
    }
  }
  return worst;
}

/// Weight of a loop under truncated least squares at convexity mu (Yang et al. 2020, eq. 14).
double truncated_weight(double chi2, double limit, double mu) {
  if (chi2 <= mu / (mu + 1.0) * limit) {
    return 1.0;
  }
  if (chi2 >= (mu + 1.0) / mu * limit) {
    return 0.0;
  }
  return std::clamp(std::sqrt(limit * mu * (mu + 1.0) / chi2) - mu, 0.0, 1.0);
}

/// Sets the weights of doubted loops; true when all are 0 or 1.
bool update_weights(const PoseGraph& graph, double limit, double mu, std::vector<EdgeReport>& reports) {
  bool binary = true;
  for (std::size_t e = 0; e < reports.size(); ++e) {
    if (is_doubted(graph, reports, e)) {
      reports[e].weight = truncated_weight(reports[e].chi2, limit, mu);
      binary = binary && (reports[e].weight == 0.0 || reports[e].weight == 1.0);
    }
  }
  return binary;
}

/// Graduated non-convexity: from a nearly convex cost to truncated least squares, a few iterations each step.
void graduate(const PoseGraph& graph, const PoseGraphOptions& options, PoseGraphSolution& solution) {
  const auto step = [&] {
    const internal::SolveReport report =
        internal::solve(graph, weights_of(solution.edges), kRobustStepIterations, 1e-4, solution.T_map_node);
    solution.iterations += report.iterations;
    ++solution.robust_steps;
    measure_residuals(graph, solution.T_map_node, solution.edges);
  };
  step();
  const double worst = worst_loop_chi2(graph, solution.edges);
  if (worst <= options.inlier_chi2) {
    return;
  }
  double mu = options.inlier_chi2 / (2.0 * worst - options.inlier_chi2);
  for (std::size_t i = 0; i < kMaxRobustSteps; ++i) {
    const bool binary = update_weights(graph, options.inlier_chi2, mu, solution.edges);
    step();
    if (binary && mu > 1.0) {
      break;
    }
    mu *= options.convexity_step;
  }
}

/// Turns final weights into verdicts: a loop is in when its chi2 at the solution is below the limit, also one that
/// an earlier step had left out. Returns true when a verdict changed.
bool settle_verdicts(const PoseGraph& graph, const PoseGraphOptions& options, std::vector<EdgeReport>& reports) {
  bool changed = false;
  for (std::size_t e = 0; e < reports.size(); ++e) {
    EdgeReport& report = reports[e];
    if (graph.edges[e].kind != EdgeKind::kLoop || report.verdict == EdgeVerdict::kTooFewLinks) {
      continue;
    }
    const bool in = report.chi2 <= options.inlier_chi2;
    const bool was_in = report.verdict == EdgeVerdict::kAccepted;
    changed = changed || in != was_in || (in && report.weight != 1.0);
    report.weight = in ? 1.0 : 0.0;
    if (in) {
      report.verdict = EdgeVerdict::kAccepted;
    } else if (was_in) {
      report.verdict = EdgeVerdict::kOutlier;
    }
  }
  return changed;
}

void solve_to_the_end(const PoseGraph& graph, const PoseGraphOptions& options, PoseGraphSolution& solution) {
  const internal::SolveReport report =
      internal::solve(graph, weights_of(solution.edges), options.max_iterations, 1e-9, solution.T_map_node);
  solution.iterations += report.iterations;
  solution.initial_cost = report.initial_cost;
  solution.final_cost = report.final_cost;
  solution.converged = report.converged;
  solution.message = report.message;
  measure_residuals(graph, solution.T_map_node, solution.edges);
}

void fill_components(const PoseGraph& graph, PoseGraphSolution& solution) {
  solution.components = internal::find_components(graph, weights_of(solution.edges));
  solution.component_of.assign(graph.T_map_node.size(), 0);
  for (std::size_t c = 0; c < solution.components.size(); ++c) {
    for (const std::size_t node : solution.components[c].nodes) {
      solution.component_of[node] = c;
    }
  }
}

PoseGraph with_anchor(const PoseGraph& graph) {
  PoseGraph anchored = graph;
  if (anchored.anchors.empty() && !anchored.T_map_node.empty()) {
    anchored.anchors = {0};
  }
  return anchored;
}

}  // namespace

PoseGraphSolution optimize(const PoseGraph& given, const PoseGraphOptions& options) {
  check(options);
  internal::validate(given);
  const Stopwatch watch;
  const PoseGraph graph = with_anchor(given);
  PoseGraphSolution solution;
  solution.edges.resize(graph.edges.size());
  const internal::Segments segments = internal::find_segments(graph);
  std::vector<internal::LoopGroup> groups = internal::group_loops(graph, segments);
  if (options.consistency_check) {
    internal::keep_consistent(graph, segments, options, groups, solution.edges);
  }
  const std::size_t min_links = options.robust || options.consistency_check ? options.min_links : 1;
  internal::reject_thin_links(graph, segments, groups, min_links, solution.edges);
  solution.T_map_node = internal::placed_poses(graph, segments, groups, solution.edges, min_links);
  if (options.robust) {
    graduate(graph, options, solution);
    settle_verdicts(graph, options, solution.edges);
  }
  solve_to_the_end(graph, options, solution);
  for (std::size_t round = 1; options.robust && round < kMaxRounds; ++round) {
    const bool changed = settle_verdicts(graph, options, solution.edges);
    const bool thinner = internal::reject_thin_links(graph, segments, groups, min_links, solution.edges) > 0;
    if (!changed && !thinner) {
      break;
    }
    solve_to_the_end(graph, options, solution);
  }
  fill_components(graph, solution);
  solution.seconds = watch.seconds();
  return solution;
}

std::string to_string(EdgeVerdict verdict) {
  switch (verdict) {
    case EdgeVerdict::kAccepted:
      return "accepted";
    case EdgeVerdict::kInconsistent:
      return "inconsistent";
    case EdgeVerdict::kOutlier:
      return "outlier";
    case EdgeVerdict::kTooFewLinks:
      return "too few links";
  }
  return "unknown";
}

}  // namespace loopmark::pose_graph
