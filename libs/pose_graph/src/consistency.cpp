// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "loopmark/core/parallel.hpp"
#include "max_clique.hpp"

namespace loopmark::pose_graph::internal {
namespace {

/// A loop turned so that it leads from the first segment of its group to the second (from the earlier node to the
/// later one within one segment).
struct TurnedLoop {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose T_from_to = Pose::Identity();
  Matrix6d covariance_in_segment = Matrix6d::Zero();  ///< of its tangent, moved into the frame of the first segment

  TurnedLoop(const PoseGraphEdge& edge, const Segments& segments)
      : from(edge.from), to(edge.to), T_from_to(edge.T_from_to) {
    const Matrix6d in_first = adjoint(segments.T_segment_node[edge.from]);
    covariance_in_segment = in_first * invert_information(edge.information) * in_first.transpose();
    const std::size_t segment_from = segments.segment_of[from];
    const std::size_t segment_to = segments.segment_of[to];
    if (segment_from > segment_to || (segment_from == segment_to && from > to)) {
      turn(segments);
    }
  }

 private:
  void turn(const Segments& segments) {
    std::swap(from, to);
    T_from_to = T_from_to.inverse();
    // Into the frame of the segment that is first now: back to the old `from`, through the loop, out to the segment.
    const Matrix6d move = adjoint(segments.T_segment_node[from] * T_from_to * segments.T_segment_node[to].inverse());
    covariance_in_segment = move * covariance_in_segment * move.transpose();
  }
};

double cycle_chi2(const Segments& segments, const TurnedLoop& a, const TurnedLoop& b) {
  const Pose& T_A_i = segments.T_segment_node[a.from];
  const Pose& T_A_k = segments.T_segment_node[b.from];
  const Pose& T_B_j = segments.T_segment_node[a.to];
  const Pose& T_B_l = segments.T_segment_node[b.to];
  const Pose T_A_B = T_A_i * a.T_from_to * T_B_j.inverse();
  // The cycle i -> j -> l -> k -> i, seen from the frame of segment A; the identity when all is exact.
  const Vector6d error = log_se3(T_A_B * T_B_l * b.T_from_to.inverse() * T_A_k.inverse());
  const Matrix6d across = adjoint(T_A_B);
  const Matrix6d covariance = a.covariance_in_segment + b.covariance_in_segment +
                              segments.covariance_between(a.from, b.from) +
                              across * segments.covariance_between(a.to, b.to) * across.transpose();
  const Vector6d solved = covariance.ldlt().solve(error);
  return error.dot(solved);
}

std::vector<TurnedLoop> turned_loops(const PoseGraph& graph, const Segments& segments,
                                     const std::vector<std::size_t>& edges) {
  std::vector<TurnedLoop> loops;
  loops.reserve(edges.size());
  for (const std::size_t e : edges) {
    loops.emplace_back(graph.edges[e], segments);
  }
  return loops;
}

BitMatrix consistent_pairs(const Segments& segments, const std::vector<TurnedLoop>& loops, double threshold) {
  BitMatrix upper(loops.size());
  parallel_for(loops.size(), [&](std::size_t a) {
    for (std::size_t b = a + 1; b < loops.size(); ++b) {
      if (cycle_chi2(segments, loops[a], loops[b]) <= threshold) {
        upper.set(a, b);
      }
    }
  });
  BitMatrix both = upper;
  for (std::size_t a = 0; a < loops.size(); ++a) {
    for (std::size_t b = a + 1; b < loops.size(); ++b) {
      if (upper.test(a, b)) {
        both.set(b, a);
      }
    }
  }
  return both;
}

/// Share of the clique a loop must agree with to stay: among many loops, a true one contradicts some by chance.
constexpr double kMajority = 0.75;

/// The forced loops, the largest clique among what contradicts none of them, and those that agree with most of it;
/// places in the group's list.
std::vector<std::size_t> agreeing_places(const PoseGraph& graph, const LoopGroup& group, const BitMatrix& consistent) {
  std::vector<std::size_t> chosen;
  std::vector<std::size_t> candidates;
  for (std::size_t p = 0; p < group.edges.size(); ++p) {
    if (graph.edges[group.edges[p]].kind == EdgeKind::kForced) {
      chosen.push_back(p);
    }
  }
  for (std::size_t p = 0; p < group.edges.size(); ++p) {
    if (graph.edges[group.edges[p]].kind != EdgeKind::kForced &&
        std::all_of(chosen.begin(), chosen.end(), [&](std::size_t f) { return consistent.test(p, f); })) {
      candidates.push_back(p);
    }
  }
  BitMatrix among(candidates.size());
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    for (std::size_t b = 0; b < candidates.size(); ++b) {
      if (consistent.test(candidates[a], candidates[b])) {
        among.set(a, b);
      }
    }
  }
  const std::vector<std::size_t> clique = large_clique(among);
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const auto agrees = std::count_if(clique.begin(), clique.end(),
                                      [&](std::size_t member) { return member == c || among.test(c, member); });
    if (static_cast<double>(agrees) >= kMajority * static_cast<double>(clique.size())) {
      chosen.push_back(candidates[c]);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// The member whose summed disagreement with the others is least; a forced one before any other.
std::size_t medoid(const PoseGraph& graph, const Segments& segments, const LoopGroup& group,
                   const std::vector<TurnedLoop>& loops, const std::vector<std::size_t>& places) {
  constexpr std::size_t kCompared = 64;
  std::size_t best = places.front();
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t a : places) {
    if (graph.edges[group.edges[a]].kind == EdgeKind::kForced) {
      return group.edges[a];
    }
    double sum = 0.0;
    for (std::size_t n = 0; n < std::min(kCompared, places.size()); ++n) {
      sum += a == places[n] ? 0.0 : cycle_chi2(segments, loops[a], loops[places[n]]);
    }
    if (sum < least) {
      least = sum;
      best = a;
    }
  }
  return group.edges[best];
}

}  // namespace

double cycle_chi2(const PoseGraph& graph, const Segments& segments, std::size_t edge_a, std::size_t edge_b) {
  return cycle_chi2(segments, TurnedLoop(graph.edges[edge_a], segments), TurnedLoop(graph.edges[edge_b], segments));
}

std::vector<LoopGroup> group_loops(const PoseGraph& graph, const Segments& segments) {
  std::map<std::pair<std::size_t, std::size_t>, LoopGroup> groups;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const PoseGraphEdge& edge = graph.edges[e];
    if (edge.kind == EdgeKind::kOdometry) {
      continue;
    }
    const auto [first, second] = std::minmax(segments.segment_of[edge.from], segments.segment_of[edge.to]);
    LoopGroup& group = groups[{first, second}];
    group.first_segment = first;
    group.second_segment = second;
    group.edges.push_back(e);
  }
  std::vector<LoopGroup> list;
  for (auto& [segments_joined, group] : groups) {
    group.agreeing = group.edges;
    group.representative = group.edges.front();
    list.push_back(std::move(group));
  }
  return list;
}

void keep_consistent(const PoseGraph& graph, const Segments& segments, const PoseGraphOptions& options,
                     std::vector<LoopGroup>& groups, std::vector<EdgeReport>& reports) {
  for (LoopGroup& group : groups) {
    const std::vector<TurnedLoop> loops = turned_loops(graph, segments, group.edges);
    const BitMatrix consistent = consistent_pairs(segments, loops, options.consistency_chi2);
    const std::vector<std::size_t> places = agreeing_places(graph, group, consistent);
    group.agreeing.clear();
    for (std::size_t p = 0; p < group.edges.size(); ++p) {
      EdgeReport& report = reports[group.edges[p]];
      report.agrees_with = consistent.degree(p);
      report.group_size = group.edges.size();
      if (std::binary_search(places.begin(), places.end(), p)) {
        group.agreeing.push_back(group.edges[p]);
      } else {
        report.verdict = EdgeVerdict::kInconsistent;
        report.weight = 0.0;
      }
    }
    group.representative = medoid(graph, segments, group, loops, places);
  }
}

}  // namespace loopmark::pose_graph::internal
