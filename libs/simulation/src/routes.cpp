// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/routes.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "loopmark/core/error.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/simulation/revisits.hpp"

namespace loopmark::simulation {
namespace {

/// A random walk that prefers new streets or known ones.
struct Taste {
  double again = 0.5;      ///< weight of a street that was driven already; a new one weighs 1
  double alike = 1.0;      ///< extra weight of the alike blocks
  double turn_back = 0.0;  ///< chance of a U-turn at a node
};

Route random_walk(const RoadNetwork& roads, double length, const Taste& taste, Rng& rng) {
  Route route;
  route.start = static_cast<int>(rng.below(static_cast<std::uint32_t>(roads.nodes.size())));
  std::map<int, int> driven;
  int node = route.start;
  double done = 0.0;
  while (done < length) {
    const RoadNode& here = roads.nodes[node];
    std::vector<std::pair<int, double>> choices;
    double total = 0.0;
    for (const int edge : here.edges) {
      if (!route.edges.empty() && edge == route.edges.back()) {
        continue;
      }
      const double weight =
          (driven[edge] == 0 ? 1.0 : taste.again) * (roads.edges[edge].near_identical ? taste.alike : 1.0);
      choices.emplace_back(edge, weight);
      total += weight;
    }
    const bool back = !route.edges.empty() && (choices.empty() || rng.uniform() < taste.turn_back);
    int next = back ? route.edges.back() : choices.front().first;
    double draw = rng.uniform() * total;
    for (std::size_t i = 0; !back && i < choices.size(); ++i) {
      if (draw < choices[i].second) {
        next = choices[i].first;
        break;
      }
      draw -= choices[i].second;
    }
    const double first_or_whole = route.edges.empty() ? 0.5 : 1.0;
    route.edges.push_back(next);
    ++driven[next];
    done += first_or_whole * line_length(roads.edges[next].line);
    node = roads.other_end(next, node);
  }
  route.edges.push_back(roads.nodes[node].edges.front() == route.edges.back() ? roads.nodes[node].edges.back()
                                                                              : roads.nodes[node].edges.front());
  return route;
}

double share_alike(const RoadNetwork& roads, const LanePath& path) {
  std::size_t alike = 0;
  for (const int edge : path.edge) {
    alike += roads.edges[edge].near_identical ? 1 : 0;
  }
  return static_cast<double>(alike) / static_cast<double>(path.edge.size());
}

int u_turns(const Route& route) {
  int count = 0;
  for (std::size_t i = 0; i + 1 < route.edges.size(); ++i) {
    count += route.edges[i] == route.edges[i + 1] ? 1 : 0;
  }
  return count;
}

/// How well a route serves the tour: enough revisits of each kind, some of them far along, the alike blocks seen.
double tour_score(const Town& town, const Route& route, double length) {
  LanePath path = make_lane_path(town.roads, route, 1.7);
  const auto samples = static_cast<std::size_t>(length / kPathStep);
  if (path.points.size() > samples) {
    path.points.resize(samples);
    path.heading_rad.resize(samples);
    path.edge.resize(samples);
  }
  std::map<RevisitKind, int> counts;
  bool alike_again = false;
  for (const Revisit& r : find_revisits(path, town.roads)) {
    ++counts[r.kind];
    alike_again = alike_again || r.near_identical;
  }
  const double scale = std::max(1.0, length / 1500.0);
  // A kind that is there often enough counts for much, more of it for little.
  const auto wanted = [&](RevisitKind kind, double count) {
    const double share = counts[kind] / (count * scale);
    return 3.0 * std::min(1.0, share) + 0.3 * std::min(2.0, share);
  };
  const double alike = share_alike(town.roads, path);
  const bool roundabout = std::any_of(route.edges.begin(), route.edges.end(), [&](int e) {
    return town.roads.nodes[town.roads.edges[e].from].roundabout || town.roads.nodes[town.roads.edges[e].to].roundabout;
  });
  return wanted(RevisitKind::kSame, 3) + wanted(RevisitKind::kOpposite, 3) + wanted(RevisitKind::kCrossing, 2) +
         (alike > 0.1 && alike < 0.4 ? 1.0 : 0.0) + (alike_again ? 0.5 : 0.0) + (roundabout ? 0.5 : 0.0) +
         (u_turns(route) >= 1 && u_turns(route) <= 2.0 * scale ? 0.5 : 0.0);
}

double explore_score(const Route& route) {
  const std::set<int> different(route.edges.begin(), route.edges.end());
  return static_cast<double>(different.size()) - 0.5 * static_cast<double>(route.edges.size() - different.size()) -
         3.0 * u_turns(route);
}

template <class Score>
Route best_walk(const Town& town, double length, std::uint64_t name, int tries, double again_high, double turn_back,
                const Score& score) {
  Route best;
  double best_score = -1e9;
  for (int i = 0; i < tries; ++i) {
    Rng rng(
        task_seed(town.options.seed, {30, name, static_cast<std::uint64_t>(length), static_cast<std::uint64_t>(i)}));
    const Taste taste{rng.uniform(0.05, again_high), rng.uniform(0.7, 2.0), rng.uniform(0.0, turn_back)};
    Route route = random_walk(town.roads, length, taste, rng);
    const double value = score(route);
    if (value > best_score) {
      best_score = value;
      best = std::move(route);
    }
  }
  return best;
}

/// The shortest walk between two nodes (Dijkstra).
std::vector<int> shortest(const RoadNetwork& roads, int from, int to) {
  std::vector<double> cost(roads.nodes.size(), std::numeric_limits<double>::infinity());
  std::vector<int> via(roads.nodes.size(), -1);
  std::set<std::pair<double, int>> open = {{0.0, from}};
  cost[from] = 0.0;
  while (!open.empty()) {
    const int node = open.begin()->second;
    open.erase(open.begin());
    for (const int edge : roads.nodes[node].edges) {
      const int next = roads.other_end(edge, node);
      const double through = cost[node] + line_length(roads.edges[edge].line);
      if (through < cost[next]) {
        open.erase({cost[next], next});
        cost[next] = through;
        via[next] = edge;
        open.insert({through, next});
      }
    }
  }
  std::vector<int> edges;
  for (int node = to; node != from && via[node] >= 0; node = roads.other_end(via[node], node)) {
    edges.push_back(via[node]);
  }
  std::reverse(edges.begin(), edges.end());
  return edges;
}

/// Goes from stop to stop, again and again, until the walk is long enough.
Route round_trip(const Town& town, const std::vector<int>& stops, double length) {
  Route route;
  route.start = stops.front();
  double done = 0.0;
  for (std::size_t k = 0; done < length + 150.0; ++k) {
    for (const int edge : shortest(town.roads, stops[k % stops.size()], stops[(k + 1) % stops.size()])) {
      route.edges.push_back(edge);
      done += line_length(town.roads.edges[edge].line);
    }
  }
  return route;
}

}  // namespace

std::vector<std::string> route_names() { return {"tour", "explore", "twins", "open"}; }

Route plan_route(const Town& town, const std::string& name, double length_m) {
  const int columns = town.options.columns;
  const int rows = town.options.rows;
  const auto node = [&](int i, int j) { return j * (columns + 1) + i; };
  const double length = length_m + 40.0;
  if (name == "tour") {
    return best_walk(town, length, 1, 160, 1.5, 0.12, [&](const Route& r) { return tour_score(town, r, length_m); });
  }
  if (name == "explore") {
    return best_walk(town, length, 2, 300, 0.2, 0.0, explore_score);
  }
  if (name == "twins") {
    return round_trip(town, {node(0, 0), node(columns, 0), node(columns, rows), node(0, rows)}, length);
  }
  if (name == "open") {
    const int country = static_cast<int>(town.roads.nodes.size()) - 2;
    return round_trip(
        town, {node(columns, rows - 1), country, node(columns, 1), node(columns - 1, 1), node(columns - 1, rows - 1)},
        length);
  }
  throw InputError("unknown route \"" + name + "\" (choose from tour, explore, twins, open)");
}

}  // namespace loopmark::simulation
