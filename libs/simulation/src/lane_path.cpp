// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/lane_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopmark::simulation {
namespace {

using Line = std::vector<Eigen::Vector2d>;
constexpr double kRoundaboutCut = 18.0;
constexpr double kRoundaboutRadius = 9.6;
constexpr double kUturnCut = 17.0;
constexpr double kUturnRadius = 4.6;

Eigen::Vector2d left_of(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

/// A street driven in one direction.
struct Leg {
  Line line;
  double length = 0.0;
  int edge = 0;
};

class PathBuilder {
 public:
  PathBuilder(const RoadNetwork& roads, const Route& route, double offset) : roads_(roads), offset_(offset) {
    nodes_ = route.nodes(roads);
    for (std::size_t k = 0; k < route.edges.size(); ++k) {
      Leg leg{roads.edges[route.edges[k]].line, 0.0, route.edges[k]};
      if (roads.edges[route.edges[k]].from != nodes_[k]) {
        std::reverse(leg.line.begin(), leg.line.end());
      }
      leg.length = line_length(leg.line);
      legs_.push_back(std::move(leg));
    }
  }

  void run() {
    for (std::size_t k = 0; k < legs_.size(); ++k) {
      const double from = k == 0 ? 0.5 * legs_[k].length : cut(k, k - 1);
      const double to = k + 1 == legs_.size() ? 0.5 * legs_[k].length : legs_[k].length - cut(k, k);
      follow(legs_[k], std::min(from, to - 0.1), to);
      if (k + 1 < legs_.size()) {
        turn(k);
      }
    }
  }

  const Line& line() const { return line_; }
  const std::vector<int>& edges() const { return edges_; }

 private:
  /// How much of leg k is left out at the junction between legs j and j + 1.
  double cut(std::size_t k, std::size_t j) const {
    const double most = 0.42 * legs_[k].length;
    if (roads_.nodes[nodes_[j + 1]].roundabout) {
      return std::min(most, kRoundaboutCut);
    }
    return std::min(most, legs_[j].edge == legs_[j + 1].edge ? kUturnCut : 8.5);
  }

  void add(const Eigen::Vector2d& p, int edge) {
    line_.push_back(p);
    edges_.push_back(edge);
  }

  void follow(const Leg& leg, double from, double to) {
    const int count = std::max(1, static_cast<int>(to - from));
    for (int i = 0; i <= count; ++i) {
      const LinePoint p = line_at(leg.line, from + (to - from) * i / count);
      add(p.position + offset_ * p.right(), leg.edge);
    }
  }

  void curve(const Eigen::Vector2d& p1, const Eigen::Vector2d& t0, const Eigen::Vector2d& t1, int edge) {
    const Eigen::Vector2d p0 = line_.back();
    const double reach = (p1 - p0).norm();
    const int count = std::max(2, static_cast<int>(2.0 * reach));
    for (int i = 1; i <= count; ++i) {
      const double t = static_cast<double>(i) / count;
      const double t2 = t * t;
      const double t3 = t2 * t;
      add((2 * t3 - 3 * t2 + 1) * p0 + (t3 - 2 * t2 + t) * reach * t0 + (-2 * t3 + 3 * t2) * p1 +
              (t3 - t2) * reach * t1,
          edge);
    }
  }

  void arc(const Eigen::Vector2d& centre, double radius, double from, double sweep, int edge) {
    const int count = std::max(2, static_cast<int>(2.0 * radius * std::abs(sweep)));
    for (int i = 0; i <= count; ++i) {
      const double angle = from + sweep * i / count;
      add(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)), edge);
    }
  }

  void turn(std::size_t k) {
    const Leg& in = legs_[k];
    const Leg& out = legs_[k + 1];
    const LinePoint from = line_at(in.line, in.length - cut(k, k));
    const LinePoint to = line_at(out.line, cut(k + 1, k));
    const Eigen::Vector2d target = to.position + offset_ * to.right();
    if (roads_.nodes[nodes_[k + 1]].roundabout) {
      round(roads_.nodes[nodes_[k + 1]].position, from, to, target, in.edge, out.edge);
    } else if (in.edge == out.edge) {
      const LinePoint middle = line_at(in.line, in.length - 6.0);
      const double start = std::atan2(middle.right().y(), middle.right().x());
      curve(middle.position + kUturnRadius * middle.right(), from.tangent, middle.tangent, in.edge);
      arc(middle.position, kUturnRadius, start, std::numbers::pi, in.edge);
      curve(target, -middle.tangent, to.tangent, out.edge);
    } else {
      curve(target, from.tangent, to.tangent, out.edge);
    }
  }

  void round(const Eigen::Vector2d& centre, const LinePoint& from, const LinePoint& to, const Eigen::Vector2d& target,
             int in_edge, int out_edge) {
    const auto angle_of = [&](const Eigen::Vector2d& p) { return std::atan2(p.y() - centre.y(), p.x() - centre.x()); };
    const double enter = angle_of(from.position) + 0.45;
    double sweep = std::fmod(angle_of(to.position) - 0.45 - enter, 2.0 * std::numbers::pi);
    if (sweep < 0.15) {
      sweep += 2.0 * std::numbers::pi;
    }
    const auto on_ring = [&](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
    curve(centre + kRoundaboutRadius * on_ring(enter), from.tangent, left_of(on_ring(enter)), in_edge);
    arc(centre, kRoundaboutRadius, enter, sweep, out_edge);
    curve(target, left_of(on_ring(enter + sweep)), to.tangent, out_edge);
  }

  const RoadNetwork& roads_;
  double offset_;
  std::vector<int> nodes_;
  std::vector<Leg> legs_;
  Line line_;
  std::vector<int> edges_;
};

/// Samples at even distances along a polyline.
void resample(Line& line, std::vector<int>& edges) {
  Line even = {line.front()};
  std::vector<int> even_edges = {edges.front()};
  double left = kPathStep;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double step = (line[i + 1] - line[i]).norm();
    double at = left;
    for (; at <= step; at += kPathStep) {
      even.push_back(line[i] + at / step * (line[i + 1] - line[i]));
      even_edges.push_back(edges[i + 1]);
    }
    left = at - step;
  }
  line = std::move(even);
  edges = std::move(even_edges);
}

void smooth(Line& line, std::size_t reach) {
  Line result = line;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::size_t r = std::min({reach, i, line.size() - 1 - i});
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t k = i - r; k <= i + r; ++k) {
      sum += line[k];
    }
    result[i] = sum / static_cast<double>(2 * r + 1);
  }
  line = std::move(result);
}

std::vector<double> headings(const Line& line) {
  std::vector<double> values;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d d = line[std::min(i + 2, line.size() - 1)] - line[i < 2 ? 0 : i - 2];
    double angle = std::atan2(d.y(), d.x());
    if (!values.empty()) {
      angle = values.back() + std::remainder(angle - values.back(), 2.0 * std::numbers::pi);
    }
    values.push_back(angle);
  }
  return values;
}

}  // namespace

Route Route::reversed(const RoadNetwork& roads) const {
  Route back;
  back.start = nodes(roads).back();
  back.edges.assign(edges.rbegin(), edges.rend());
  return back;
}

std::vector<int> Route::nodes(const RoadNetwork& roads) const {
  std::vector<int> list = {start};
  for (const int edge : edges) {
    list.push_back(roads.other_end(edge, list.back()));
  }
  return list;
}

Eigen::Vector2d LanePath::position(double distance) const {
  const double at = std::clamp(distance / kPathStep, 0.0, static_cast<double>(points.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(at), points.size() - 2);
  return points[i] + (at - static_cast<double>(i)) * (points[i + 1] - points[i]);
}

double LanePath::heading(double distance) const {
  const double at = std::clamp(distance / kPathStep, 0.0, static_cast<double>(points.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(at), points.size() - 2);
  return heading_rad[i] + (at - static_cast<double>(i)) * (heading_rad[i + 1] - heading_rad[i]);
}

double LanePath::curvature(double distance) const {
  return (heading(distance + 0.75) - heading(distance - 0.75)) / 1.5;
}

LanePath make_lane_path(const RoadNetwork& roads, const Route& route, double offset_m) {
  PathBuilder builder(roads, route, offset_m);
  builder.run();
  LanePath path;
  path.points = builder.line();
  path.edge = builder.edges();
  resample(path.points, path.edge);
  for (int pass = 0; pass < 3; ++pass) {
    smooth(path.points, 5);
  }
  resample(path.points, path.edge);
  path.heading_rad = headings(path.points);
  return path;
}

}  // namespace loopmark::simulation
