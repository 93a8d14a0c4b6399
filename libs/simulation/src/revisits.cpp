// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/revisits.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace loopmark::simulation {
namespace {

constexpr double kStep = 1.0;

struct Meeting {
  double at = 0.0;  ///< along the path
  double earlier = 0.0;
  double distance = 0.0;
  RevisitKind kind = RevisitKind::kSame;
};

RevisitKind kind_of(double turn_rad) {
  const double turn = std::abs(std::remainder(turn_rad, 2.0 * std::numbers::pi));
  return turn < 0.25 * std::numbers::pi
             ? RevisitKind::kSame
             : (turn > 0.75 * std::numbers::pi ? RevisitKind::kOpposite : RevisitKind::kCrossing);
}

/// Finds for each metre of the path the nearest earlier place.
class Finder {
 public:
  Finder(const LanePath& path, const RevisitRule& rule) : path_(path), rule_(rule) {}

  std::vector<Meeting> run() {
    std::vector<Meeting> meetings;
    const int count = static_cast<int>(path_.length() / kStep);
    const int gap = static_cast<int>(rule_.gap_m / kStep);
    for (int i = 0; i <= count; ++i) {
      if (i >= gap) {
        cells_[cell(path_.position((i - gap) * kStep))].push_back(i - gap);
      }
      if (const auto meeting = nearest(i)) {
        meetings.push_back(*meeting);
      }
    }
    return meetings;
  }

 private:
  std::pair<int, int> cell(const Eigen::Vector2d& p) const {
    return {static_cast<int>(std::floor(p.x() / rule_.near_m)), static_cast<int>(std::floor(p.y() / rule_.near_m))};
  }

  std::optional<Meeting> nearest(int i) const {
    const Eigen::Vector2d p = path_.position(i * kStep);
    const auto [cx, cy] = cell(p);
    std::optional<Meeting> best;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto found = cells_.find({cx + dx, cy + dy});
        for (const int j : found == cells_.end() ? std::vector<int>{} : found->second) {
          const double distance = (path_.position(j * kStep) - p).norm();
          if (distance < (best ? best->distance : rule_.near_m)) {
            best =
                Meeting{i * kStep, j * kStep, distance, kind_of(path_.heading(i * kStep) - path_.heading(j * kStep))};
          }
        }
      }
    }
    return best;
  }

  const LanePath& path_;
  RevisitRule rule_;
  std::map<std::pair<int, int>, std::vector<int>> cells_;
};

bool continues(const Meeting& last, const Meeting& next) {
  return next.kind == last.kind && next.at - last.at < 2.5 * kStep && std::abs(next.earlier - last.earlier) < 14.0;
}

Revisit make_revisit(const std::vector<Meeting>& run, const LanePath& path, const RoadNetwork& roads) {
  Revisit r;
  r.kind = run.front().kind;
  r.begin_m = run.front().at;
  r.end_m = run.back().at;
  r.earlier_begin_m = r.earlier_end_m = run.front().earlier;
  r.nearest_m = run.front().distance;
  std::size_t alike = 0;
  for (const Meeting& m : run) {
    r.earlier_begin_m = std::min(r.earlier_begin_m, m.earlier);
    r.earlier_end_m = std::max(r.earlier_end_m, m.earlier);
    r.nearest_m = std::min(r.nearest_m, m.distance);
    alike += roads.edges[path.edge[static_cast<std::size_t>(m.at / kPathStep)]].near_identical ? 1 : 0;
  }
  r.near_identical = 2 * alike > run.size();
  return r;
}

}  // namespace

const char* name_of(RevisitKind kind) {
  switch (kind) {
    case RevisitKind::kSame:
      return "same";
    case RevisitKind::kOpposite:
      return "opposite";
    case RevisitKind::kCrossing:
    default:
      return "crossing";
  }
}

std::vector<Revisit> find_revisits(const LanePath& path, const RoadNetwork& roads, const RevisitRule& rule) {
  const std::vector<Meeting> meetings = Finder(path, rule).run();
  std::vector<Revisit> runs;
  std::vector<Meeting> run;
  for (std::size_t i = 0; i <= meetings.size(); ++i) {
    if (!run.empty() && (i == meetings.size() || !continues(run.back(), meetings[i]))) {
      runs.push_back(make_revisit(run, path, roads));
      run.clear();
    }
    if (i < meetings.size()) {
      run.push_back(meetings[i]);
    }
  }
  std::erase_if(runs, [&](const Revisit& r) { return r.kind != RevisitKind::kCrossing && r.length() < rule.least_m; });
  const auto beside_a_street = [&](const Revisit& crossing) {
    return std::any_of(runs.begin(), runs.end(), [&](const Revisit& r) {
      return r.kind != RevisitKind::kCrossing && r.begin_m < crossing.end_m + 15.0 && r.end_m > crossing.begin_m - 15.0;
    });
  };
  std::vector<Revisit> kept;
  for (const Revisit& r : runs) {
    if (r.kind != RevisitKind::kCrossing || (!beside_a_street(r) && r.length() >= 3.0)) {
      kept.push_back(r);
    }
  }
  return kept;
}

}  // namespace loopmark::simulation
