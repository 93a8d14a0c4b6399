// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/road_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "loopmark/core/random.hpp"

namespace loopmark::simulation {
namespace {

constexpr double kTwinSpacing = 68.0;
using Line = std::vector<Eigen::Vector2d>;

/// Cubic Hermite curve, about a point a metre.
Line hermite(const Eigen::Vector2d& p0, const Eigen::Vector2d& m0, const Eigen::Vector2d& p1,
             const Eigen::Vector2d& m1) {
  const int count = std::max(2, static_cast<int>((p1 - p0).norm()));
  Line line;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    const double t2 = t * t;
    const double t3 = t2 * t;
    line.emplace_back((2 * t3 - 3 * t2 + 1) * p0 + (t3 - 2 * t2 + t) * m0 + (-2 * t3 + 3 * t2) * p1 + (t3 - t2) * m1);
  }
  return line;
}

class Planner {
 public:
  explicit Planner(const RoadPlan& plan) : plan_(plan), rng_(task_seed(plan.seed, {2})) {}

  RoadLayout run() {
    place_nodes();
    link_grid();
    choose_roundabout();
    add_country_road();
    for (int e = 0; e < static_cast<int>(roads().edges.size()); ++e) {
      roads().nodes[roads().edges[e].from].edges.push_back(e);
      roads().nodes[roads().edges[e].to].edges.push_back(e);
    }
    return std::move(layout_);
  }

 private:
  RoadNetwork& roads() { return layout_.network; }
  int node_index(int i, int j) const { return j * (plan_.columns + 1) + i; }
  const Eigen::Vector2d& at(int node) { return roads().nodes[node].position; }

  std::vector<double> uneven_steps(int count, double low, double high) {
    std::vector<double> places = {0.0};
    for (int i = 0; i < count; ++i) {
      places.push_back(places.back() + rng_.uniform(low, high));
    }
    return places;
  }

  void place_nodes() {
    const std::vector<double> ys = uneven_steps(plan_.rows, 66.0, 92.0);
    std::vector<double> xs = uneven_steps(plan_.columns, 48.0, 92.0);
    const double width = kTwinSpacing * plan_.columns;
    const double stretch = width / xs.back();
    for (int j = 0; j <= plan_.rows; ++j) {
      const int from_end = std::min(j, plan_.rows - j);
      const double uneven = std::min(1.0, 0.5 * from_end);
      for (int i = 0; i <= plan_.columns; ++i) {
        const Eigen::Vector2d jitter(rng_.uniform(-5.0, 5.0), rng_.uniform(-5.0, 5.0));
        Eigen::Vector2d p((1.0 - uneven) * kTwinSpacing * i + uneven * stretch * xs[i], ys[j]);
        roads().nodes.push_back({from_end > 0 ? Eigen::Vector2d(p + jitter) : p, {}, false});
      }
    }
    layout_.level_rows_y = {0.0, ys.back()};
    layout_.river_x = width + 62.0;
    layout_.low = {-110.0, -110.0};
    layout_.high = {width + 380.0, ys.back() + 110.0};
  }

  Zone choose_zone(int i, int j) {
    constexpr std::array<Zone, 10> kMix = {Zone::kTerraced,   Zone::kTerraced, Zone::kTerraced, Zone::kApartments,
                                           Zone::kApartments, Zone::kVillas,   Zone::kVillas,   Zone::kCommercial,
                                           Zone::kPark,       Zone::kVillas};
    // Neighbouring streets tend to be alike: the choice is made for districts of 2 x 2 blocks, with exceptions.
    Rng district(task_seed(plan_.seed, {3, static_cast<std::uint64_t>(i / 2), static_cast<std::uint64_t>(j / 2)}));
    return rng_.uniform() < 0.6 ? kMix[district.below(10)] : kMix[rng_.below(10)];
  }

  RoadEdge& link(int a, int b, double bend) {
    const Eigen::Vector2d along = at(b) - at(a);
    const Eigen::Vector2d across(-along.y(), along.x());
    RoadEdge edge;
    edge.from = a;
    edge.to = b;
    edge.line = hermite(at(a), along + bend * across, at(b), along - bend * across);
    edge.half_width_m = rng_.uniform() < 0.25 ? 6.8 : rng_.uniform(5.0, 5.8);
    edge.sidewalk_m = rng_.uniform(1.8, 3.4);
    edge.speed_limit_mps = edge.half_width_m > 6.0 ? 13.9 : rng_.uniform(8.5, 11.5);
    roads().edges.push_back(edge);
    return roads().edges.back();
  }

  void link_twins(int a, int b, bool turned) {
    RoadEdge& edge = link(a, b, 0.0);
    edge.half_width_m = 5.2;
    edge.sidewalk_m = 2.4;
    edge.speed_limit_mps = 10.5;
    edge.zone = Zone::kTwins;
    edge.near_identical = true;
    edge.turned = turned;
  }

  double choose_bend() {
    const double kind = rng_.uniform();
    return kind < 0.4 ? 0.0 : rng_.uniform(-1.0, 1.0) * (kind < 0.75 ? 0.25 : 0.6);
  }

  bool leave_out(bool inner) { return inner && rng_.uniform() < 0.12; }

  void link_grid() {
    for (int j = 0; j <= plan_.rows; ++j) {
      for (int i = 0; i < plan_.columns; ++i) {
        const bool border = j == 0 || j == plan_.rows;
        if (border) {
          link_twins(node_index(i, j), node_index(i + 1, j), j != 0);
        } else if (!leave_out(i > 0 && i + 1 < plan_.columns)) {
          link(node_index(i, j), node_index(i + 1, j), choose_bend()).zone = choose_zone(i, j);
        }
      }
    }
    for (int j = 0; j < plan_.rows; ++j) {
      for (int i = 0; i <= plan_.columns; ++i) {
        const bool inner = i > 0 && i < plan_.columns && j > 0 && j + 1 < plan_.rows && (i + j) % 2 == 0;
        if (!leave_out(inner)) {
          // Side streets leave the rows of alike blocks at a right angle and straight.
          const bool at_twins = j == 0 || j + 1 == plan_.rows;
          link(node_index(i, j), node_index(i, j + 1), at_twins ? 0.0 : choose_bend()).zone = choose_zone(i, j);
        }
      }
    }
  }

  void choose_roundabout() {
    const int i = 1 + static_cast<int>(rng_.below(static_cast<std::uint32_t>(plan_.columns - 1)));
    const int j = 1 + static_cast<int>(rng_.below(static_cast<std::uint32_t>(plan_.rows - 1)));
    roads().nodes[node_index(i, j)].roundabout = true;
  }

  void add_country_road() {
    const int first = node_index(plan_.columns, plan_.rows - 1);
    const int last = node_index(plan_.columns, 1);
    const double east = layout_.river_x;
    const double mid = 0.5 * (at(first).y() + at(last).y());
    const double reach = 0.5 * (at(first).y() - at(last).y());
    const Line middle = {{east + 55.0, at(first).y() + 12.0},
                         {east + 165.0, mid + 0.62 * reach},
                         {east + 180.0, mid - 0.55 * reach},
                         {east + 55.0, at(last).y() - 10.0}};
    std::vector<int> chain = {first};
    for (const Eigen::Vector2d& p : middle) {
      roads().nodes.push_back({p, {}, false});
      chain.push_back(static_cast<int>(roads().nodes.size()) - 1);
    }
    chain.push_back(last);
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
      RoadEdge& edge = link(chain[k], chain[k + 1], 0.0);
      edge.line = hermite(at(chain[k]), country_tangent(chain, k), at(chain[k + 1]), country_tangent(chain, k + 1));
      edge.half_width_m = 4.2;
      edge.sidewalk_m = 0.0;
      edge.speed_limit_mps = 15.0;
      edge.zone = Zone::kOpen;
    }
  }

  /// Catmull-Rom tangents, so that the country road bends without corners.
  Eigen::Vector2d country_tangent(const std::vector<int>& chain, std::size_t k) {
    if (k == 0) {
      return {60.0, 0.0};
    }
    if (k + 1 == chain.size()) {
      return {-60.0, 0.0};
    }
    return 0.5 * (at(chain[k + 1]) - at(chain[k - 1]));
  }

  RoadPlan plan_;
  Rng rng_;
  RoadLayout layout_;
};

}  // namespace

int RoadNetwork::other_end(int edge, int node) const {
  return edges[edge].from == node ? edges[edge].to : edges[edge].from;
}

double line_length(const std::vector<Eigen::Vector2d>& line) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    length += (line[i + 1] - line[i]).norm();
  }
  return length;
}

LinePoint line_at(const std::vector<Eigen::Vector2d>& line, double distance) {
  std::size_t i = 0;
  double step = (line[1] - line[0]).norm();
  while (i + 2 < line.size() && distance > step) {
    distance -= step;
    ++i;
    step = (line[i + 1] - line[i]).norm();
  }
  const Eigen::Vector2d tangent = (line[i + 1] - line[i]) / std::max(step, 1e-9);
  return {line[i] + std::clamp(distance, 0.0, step) * tangent, tangent};
}

RoadLayout make_roads(const RoadPlan& plan) { return Planner(plan).run(); }

}  // namespace loopmark::simulation
