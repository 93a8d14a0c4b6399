// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/kidnap_benchmark/drill_plan.hpp"

#include <algorithm>
#include <optional>

#include "loopmark/core/error.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::kidnap_benchmark {
namespace {

constexpr double kUsualGapS = 0.1;   ///< between the scans before and behind a teleport
constexpr double kTurnedGapS = 1.0;  ///< while the sensor is turned
constexpr std::size_t kTries = 40;   ///< of a stratum

constexpr Disturbance kDisturbances[] = {Disturbance::kOutage, Disturbance::kTeleport, Disturbance::kTurned,
                                         Disturbance::kOtherDrive};

std::optional<Disturbance> disturbance_named(const std::string& word) {
  for (const Disturbance disturbance : kDisturbances) {
    if (word == name(disturbance)) {
      return disturbance;
    }
  }
  return std::nullopt;
}

class Planner {
 public:
  Planner(const std::vector<DrillScan>& run, const std::vector<DrillScan>& other, const DrillOptions& options)
      : run_(run), other_(other), options_(options) {
    for (const std::string& word : options.disturbances) {
      const Disturbance disturbance = *disturbance_named(word);
      if (disturbance != Disturbance::kOtherDrive || !other.empty()) {
        disturbances_.push_back(disturbance);
      }
    }
  }

  bool can_do_anything() const { return !disturbances_.empty() && !run_.empty(); }

  std::optional<DrillEvent> event(std::size_t number) const {
    const Disturbance disturbance = disturbances_[number % disturbances_.size()];
    const std::size_t turn = number / disturbances_.size();
    Rng rng(task_seed(options_.seed, {number}));
    const auto& arrivals = disturbance == Disturbance::kOtherDrive ? other_ : run_;
    const std::vector<Stratum> strata = strata_of(arrivals);
    for (std::size_t attempt = 0; attempt < kTries * strata.size(); ++attempt) {
      DrillEvent event;
      event.number = number;
      event.disturbance = disturbance;
      event.stratum = strata[(turn + attempt / kTries) % strata.size()];  // the next one where this one does not do
      event.after = drawn(arrivals, event.stratum, rng);
      event.outage_s = options_.outages_s[(turn + attempt) % options_.outages_s.size()];
      if (draw_start(event, arrivals[event.after], rng)) {
        return event;
      }
    }
    return std::nullopt;
  }

 private:
  static std::vector<Stratum> strata_of(const std::vector<DrillScan>& scans) {
    std::vector<Stratum> there;
    for (const Stratum stratum : kStrata) {
      if (std::any_of(scans.begin(), scans.end(), [&](const DrillScan& s) { return s.stratum == stratum; })) {
        there.push_back(stratum);
      }
    }
    return there;
  }

  static std::size_t drawn(const std::vector<DrillScan>& scans, Stratum stratum, Rng& rng) {
    std::vector<std::size_t> of_it;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (scans[i].stratum == stratum) {
        of_it.push_back(i);
      }
    }
    return of_it[rng.below(static_cast<std::uint32_t>(of_it.size()))];
  }

  /// The last scan of the run that was taken at `stamp_s` or before, if tracking can be long enough until then.
  std::optional<std::size_t> last_until(double stamp_s) const {
    std::size_t count = 0;
    while (count < run_.size() && run_[count].stamp_s <= stamp_s) {
      ++count;
    }
    const bool long_enough = count > 0 && run_[count - 1].stamp_s - run_.front().stamp_s >= options_.before_s;
    return long_enough ? std::optional(count - 1) : std::nullopt;
  }

  bool draw_start(DrillEvent& event, const DrillScan& arrival, Rng& rng) const {
    if (event.disturbance == Disturbance::kOutage || event.disturbance == Disturbance::kTurned) {
      if (event.disturbance == Disturbance::kTurned) {
        event.outage_s = kTurnedGapS;
        event.yaw_deg = rng.uniform(-180.0, 180.0);
      }
      const auto before = last_until(arrival.stamp_s - event.outage_s);
      event.before = before.value_or(0);
      event.outage_s = before ? arrival.stamp_s - run_[*before].stamp_s : 0.0;
      return before.has_value();
    }
    event.before = rng.below(static_cast<std::uint32_t>(run_.size()));
    event.outage_s = kUsualGapS;
    const double far = (run_[event.before].T_map_lidar.translation() - arrival.T_map_lidar.translation()).norm();
    return run_[event.before].stamp_s - run_.front().stamp_s >= options_.before_s && far >= options_.teleport_m;
  }

  const std::vector<DrillScan>& run_;
  const std::vector<DrillScan>& other_;
  const DrillOptions& options_;
  std::vector<Disturbance> disturbances_;
};

}  // namespace

const char* name(Disturbance disturbance) {
  switch (disturbance) {
    case Disturbance::kOutage:
      return "outage";
    case Disturbance::kTeleport:
      return "teleport";
    case Disturbance::kTurned:
      return "turned";
    case Disturbance::kOtherDrive:
      break;
  }
  return "other-drive";
}

void check(const DrillOptions& o) {
  require_option(o.events >= 1 && o.events <= 100000, "events", "must be 1 to 100000");
  require_option(!o.outages_s.empty(), "outages_s", "needs at least one length");
  for (const std::string& word : o.disturbances) {
    require_option(disturbance_named(word).has_value(), "disturbances",
                   "'" + word + "' is none of outage, teleport, turned, other-drive");
  }
  for (const double outage : o.outages_s) {
    require_option(outage > 0.0 && outage <= 3600.0, "outages_s", "each must be above 0, at most 3600");
  }
  require_option(o.teleport_m > 0.0, "teleport_m", "must be positive");
  require_option(o.within_s > 0.0 && o.limit_s >= o.within_s, "limit_s", "must be at least within_s > 0");
  require_option(o.before_s >= 0.0 && o.settle_s >= 0.0, "settle_s", "must not be negative");
  require_option(o.right_m > 0.0 && o.right_deg > 0.0, "right_m", "must be positive");
}

std::vector<DrillEvent> plan_drill(const std::vector<DrillScan>& run, const std::vector<DrillScan>& other,
                                   const DrillOptions& options) {
  check(options);
  std::vector<DrillEvent> events;
  const Planner planner(run, other, options);
  if (planner.can_do_anything()) {
    for (std::size_t number = 0; number < options.events; ++number) {
      if (const auto event = planner.event(number)) {
        events.push_back(*event);
      }
    }
  }
  if (events.empty()) {
    throw InputError("the run is too short for a drill of this kind: map a longer log, or see drill.disturbances, " +
                     std::string("drill.before_s and drill.outages_s in: loopmark config dump"));
  }
  return events;
}

}  // namespace loopmark::kidnap_benchmark
