// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_page/findings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "loopmark/mapping/map_components.hpp"

namespace loopmark::map_page {
namespace {

constexpr double kNearThreshold = 0.1;  // of P(correct): a loop this near to min_loop_p could have gone either way
constexpr double kSureP = 0.9;          // a loop this sure that the graph refuses is a contradiction to look at
constexpr double kUnheldSigma_m = 0.5;  // more than a kerb and a half: height or place cannot be relied upon
constexpr double kHeightOverLevel =
    2.0;                              // sigma of the height against that of the level position: height is the matter
constexpr std::size_t kShortRun = 3;  // scans: findings about shorter stretches are noise

std::string fixed(double value, int decimals) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string plural(std::size_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

std::string time_of_day(double stamp_s) {
  const auto second = static_cast<long long>(std::floor(stamp_s)) % 86400;
  const auto day = (second + 86400) % 86400;
  char text[16];
  std::snprintf(text, sizeof text, "%02lld:%02lld:%02lld", day / 3600, day / 60 % 60, day % 60);
  return text;
}

/// Scans [first, last] in a row.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t size() const { return last - first + 1; }
};

std::vector<Run> runs_where(std::size_t count, const std::function<bool(std::size_t)>& holds) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < count; ++i) {
    if (holds(i)) {
      if (!runs.empty() && runs.back().last + 1 == i) {
        runs.back().last = i;
      } else {
        runs.push_back({i, i});
      }
    }
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.size() > b.size(); });
  return runs;
}

std::string name(const Run& run) {
  return run.first == run.last ? "scan " + std::to_string(run.first)
                               : "scans " + std::to_string(run.first) + " to " + std::to_string(run.last);
}

std::size_t scans_of(const std::vector<Run>& runs) {
  std::size_t sum = 0;
  for (const Run& run : runs) {
    sum += run.size();
  }
  return sum;
}

std::vector<FindingLink> links(const std::vector<Run>& runs) {
  std::vector<FindingLink> result;
  for (const Run& run : runs) {
    result.push_back({name(run), LinkKind::kScans, run.first, run.last});
  }
  return result;
}

std::vector<FindingLink> links(const MapRecords& r, const std::vector<std::size_t>& loops) {
  std::vector<FindingLink> result;
  for (const std::size_t i : loops) {
    const map_store::LoopRecord& loop = r.loops[i];
    result.push_back(
        {std::to_string(r.map.keyframes[loop.source].scan) + "-" + std::to_string(r.map.keyframes[loop.target].scan),
         LinkKind::kLoop, i, i});
  }
  return result;
}

void add_components(const MapRecords& r, std::vector<Finding>& all) {
  const std::vector<mapping::MapComponent> components = mapping::map_components(r.scans, r.loops, r.map);
  if (components.size() < 2) {
    return;
  }
  std::size_t apart = 0;
  std::vector<FindingLink> where;
  for (std::size_t c = 1; c < components.size(); ++c) {
    apart += components[c].scans;
    where.push_back({components[c].name, LinkKind::kScans, components[c].first_scan, components[c].last_scan});
  }
  all.push_back({Severity::kProblem,
                 plural(components.size() - 1, "part") + " of the drive (" + plural(apart, "scan") +
                     ") found no place in the map: shown beside it, in frames of their own.",
                 where});
}

void add_lost(const MapRecords& r, std::vector<Finding>& all) {
  const std::vector<Run> lost = runs_where(r.scans.size(), [&](std::size_t i) {
    return r.scans[i].tracking == odometry::Tracking::kLost && r.scans[i].state != map_store::ScanState::kDamaged;
  });
  if (!lost.empty()) {
    all.push_back({Severity::kProblem,
                   "Tracking was lost for " + plural(scans_of(lost), "scan") + ", longest at " +
                       time_of_day(r.scans[lost.front().first].stamp_s) + ".",
                   links(lost)});
  }
  const std::vector<Run> found =
      runs_where(r.scans.size(), [&](std::size_t i) { return r.scans[i].state == map_store::ScanState::kRecovered; });
  if (!found.empty()) {
    all.push_back({Severity::kLook,
                   plural(scans_of(found), "scan") +
                       " after a loss got their pose by registration to earlier keyframes: see whether they lie right.",
                   links(found)});
  }
  const std::vector<Run> damaged =
      runs_where(r.scans.size(), [&](std::size_t i) { return r.scans[i].state == map_store::ScanState::kDamaged; });
  if (!damaged.empty()) {
    all.push_back({Severity::kLook,
                   plural(scans_of(damaged), "scan") + " could not be used; their poses are interpolated.",
                   links(damaged)});
  }
}

void add_uncertainty(const MapRecords& r, std::vector<Finding>& all) {
  std::vector<Eigen::Vector3d> sigma;
  for (std::size_t i = 0; i < r.scans.size(); ++i) {
    sigma.push_back(position_sigma(r.map.T_map_scan[i], r.map.covariance[i]));
  }
  const auto level = [&](std::size_t i) { return std::hypot(sigma[i].x(), sigma[i].y()); };
  const auto add = [&](const std::string& what, const std::function<double(std::size_t)>& value,
                       const std::function<bool(std::size_t)>& holds) {
    std::vector<Run> runs = runs_where(r.scans.size(), holds);
    std::erase_if(runs, [](const Run& run) { return run.size() < kShortRun; });
    if (runs.empty()) {
      return;
    }
    double most = 0.0;
    for (const Run& run : runs) {
      for (std::size_t i = run.first; i <= run.last; ++i) {
        most = std::max(most, value(i));
      }
    }
    all.push_back(
        {Severity::kLook,
         what + " is not held for " + plural(scans_of(runs), "scan") + " (1 sigma up to " + fixed(most, 2) + " m).",
         links(runs)});
  };
  add(
      "Height", [&](std::size_t i) { return sigma[i].z(); },
      [&](std::size_t i) { return sigma[i].z() > kUnheldSigma_m && sigma[i].z() > kHeightOverLevel * level(i); });
  add("The level position", level, [&](std::size_t i) { return level(i) > 2.0 * kUnheldSigma_m; });
}

void add_degenerate(const MapRecords& r, std::vector<Finding>& all) {
  std::vector<Run> runs =
      runs_where(r.scans.size(), [&](std::size_t i) { return r.scans[i].tracking == odometry::Tracking::kDegenerate; });
  std::erase_if(runs, [](const Run& run) { return run.size() < kShortRun; });
  if (!runs.empty()) {
    all.push_back(
        {Severity::kLook,
         "For " + plural(scans_of(runs), "scan") +
             " the surroundings hold a direction hardly at all (a tunnel, an open field): odometry may slide.",
         links(runs)});
  }
}

std::vector<std::size_t> loops_where(const MapRecords& r, const std::function<bool(std::size_t)>& holds,
                                     const std::function<double(std::size_t)>& order) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < r.loops.size(); ++i) {
    if (holds(i)) {
      found.push_back(i);
    }
  }
  std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) { return order(a) < order(b); });
  return found;
}

bool decided(const MapRecords& r, std::size_t i) {
  return map_store::loop_override_of(r.decisions, r.loops[i].source, r.loops[i].target).has_value();
}

void add_loops(const MapRecords& r, std::vector<Finding>& all) {
  const auto margin = [&](std::size_t i) { return std::abs(r.loops[i].p_correct - r.min_loop_p); };
  const auto near = loops_where(
      r,
      [&](std::size_t i) {
        return !decided(r, i) && r.loops[i].answered && margin(i) < kNearThreshold &&
               r.loops[i].p_correct < 0.5 * (1.0 + r.min_loop_p);
      },
      margin);
  if (!near.empty()) {
    all.push_back({Severity::kLook,
                   plural(near.size(), "loop") + (near.size() == 1 ? " is" : " are") + " near the threshold (P " +
                       fixed(r.min_loop_p, 2) + "): look at " + (near.size() == 1 ? "it." : "these."),
                   links(r, near)});
  }
  const auto refused = loops_where(
      r,
      [&](std::size_t i) {
        return !decided(r, i) && r.map.loops[i].edge && !r.map.loops[i].accepted && r.loops[i].p_correct >= kSureP;
      },
      [&](std::size_t i) { return -r.loops[i].p_correct; });
  if (!refused.empty()) {
    all.push_back({Severity::kLook,
                   plural(refused.size(), "loop") + " that registration is sure of contradict" +
                       (refused.size() == 1 ? "s" : "") + " the others and took no part: one of the two is wrong.",
                   links(r, refused)});
  }
  const auto by_person = loops_where(
      r, [&](std::size_t i) { return decided(r, i); }, [](std::size_t) { return 0.0; });
  if (!by_person.empty()) {
    all.push_back(
        {Severity::kLook,
         plural(by_person.size(), "loop") + (by_person.size() == 1 ? " was" : " were") + " decided by a person.",
         links(r, by_person)});
  }
}

void add_summary(const MapRecords& r, std::vector<Finding>& all) {
  const auto accepted = static_cast<std::size_t>(std::count_if(
      r.map.loops.begin(), r.map.loops.end(), [](const mapping::LoopVerdict& loop) { return loop.accepted; }));
  if (accepted == 0) {
    all.push_back({Severity::kLook,
                   "No loop was accepted: nothing corrects the drift of odometry, which grows with the distance.",
                   {}});
    return;
  }
  double most = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < r.scans.size(); ++i) {
    const double sigma = position_sigma(r.map.T_map_scan[i], r.map.covariance[i]).norm();
    if (r.map.component[i] == 0 && sigma > most) {
      most = sigma;
      at = i;
    }
  }
  all.push_back({Severity::kGood,
                 plural(accepted, "loop") + (accepted == 1 ? " holds" : " hold") +
                     " the map together; the place it is least sure of has 1 sigma of " + fixed(most, 2) + " m.",
                 {{"scan " + std::to_string(at), LinkKind::kScans, at, at}}});
}

}  // namespace

Eigen::Vector3d position_sigma(const Pose& T_map_scan, const Matrix6d& covariance) {
  Eigen::Matrix<double, 3, 6> J;
  J << Eigen::Matrix3d::Identity(), -hat(T_map_scan.translation());
  return (J * covariance * J.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

std::vector<Finding> findings(const MapRecords& records) {
  std::vector<Finding> all;
  add_components(records, all);
  add_lost(records, all);
  add_uncertainty(records, all);
  add_degenerate(records, all);
  add_loops(records, all);
  add_summary(records, all);
  std::stable_sort(all.begin(), all.end(), [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
  return all;
}

}  // namespace loopmark::map_page
