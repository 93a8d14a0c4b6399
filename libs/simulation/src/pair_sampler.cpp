// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/pair_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "loopmark/cloud/overlap.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/simulation/sweep.hpp"
#include "street_places.hpp"

namespace loopmark::simulation {
namespace {

constexpr std::size_t kBins = 7;
constexpr std::size_t kSources = 8;  ///< sources tried in one round, in parallel
constexpr std::size_t kTrials = 7;   ///< targets tried for each source
constexpr double kTrialCoarseness = 4.0;
constexpr std::size_t kPatience = 10;  ///< rounds without a pair until a bin counts as out of reach
constexpr double kNoOverlap = 0.005;

/// Where and when one scan is taken.
struct View {
  Pose T_town_lidar = Pose::Identity();
  std::size_t day = 0;
  std::uint64_t seed = 0;
  bool second_sensor = false;
};

/// A pair that may be kept.
struct Candidate {
  View source;
  View target;
  PointCloud source_cloud;
  PointCloud target_cloud;
  Pose T_target_source = Pose::Identity();
  cloud::Overlap shared;
};

class Sampler {
 public:
  Sampler(const Town& town, const PairOptions& options, const ScanSink& sink)
      : town_(town),
        o_(options),
        sink_(sink),
        places_(town),
        sensors_{sensor_model(options.sensor),
                 sensor_model(options.sensor_b.empty() ? options.sensor : options.sensor_b)} {
    for (int day = 1; day <= options.days; ++day) {
      worlds_.emplace_back(town, day);
      traffic_.emplace_back(town, worlds_.back().shapes(), TrafficOptions{},
                            task_seed(options.seed, {70, static_cast<std::uint64_t>(day)}));
    }
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      wanted_[bin] = (options.pairs + kBins - 1 - bin) / kBins;
    }
  }

  PairSample run() {
    Progress progress("simulation", "pairs", o_.pairs + o_.negatives);
    std::size_t in_vain = 0;
    for (std::size_t round = 0; in_vain < 3 * kPatience && sample_.pairs.size() < o_.pairs; ++round) {
      check_interrupt();
      const std::size_t kept = positives(round);
      in_vain = kept > 0 ? 0 : in_vain + 1;
      if (in_vain == kPatience) {
        share_out_the_rest();
      }
      progress.add(kept);
    }
    const std::size_t most_tries = 40 + 10 * o_.negatives;
    for (std::size_t i = 0; i < most_tries && sample_.negatives.size() < o_.negatives; ++i) {
      check_interrupt();
      progress.add(negative(i) ? 1 : 0);
    }
    return std::move(sample_);
  }

 private:
  View view(const internal::StreetPlace& place, std::size_t day, bool second, Rng& rng) const {
    const double yaw = place.heading_rad + rng.uniform(-0.05, 0.05);
    const double mount = o_.any_yaw ? rng.uniform(-std::numbers::pi, std::numbers::pi) : 0.0;
    const Eigen::Vector2d beside(rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4));
    View v;
    v.T_town_lidar = standing_pose(town_.terrain, place.position + beside, yaw, sensors_[second].height_m);
    v.T_town_lidar.rotate(Eigen::AngleAxisd(0.008 * rng.normal(), Eigen::Vector3d::UnitX()));
    v.T_town_lidar.rotate(Eigen::AngleAxisd(0.008 * rng.normal(), Eigen::Vector3d::UnitY()));
    v.T_town_lidar.rotate(Eigen::AngleAxisd(mount, Eigen::Vector3d::UnitZ()));
    v.day = day;
    v.seed = static_cast<std::uint64_t>(rng.next());
    v.second_sensor = second;
    return v;
  }

  /// `coarseness` times fewer columns than the sensor has.
  PointCloud render(const View& v, double coarseness) const {
    const SensorModel& sensor = sensors_[v.second_sensor];
    const double time = static_cast<double>(v.seed % 100000);
    const auto bodies = traffic_[v.day].bodies(time, time + 0.1, v.T_town_lidar, sensor.max_range_m + 10.0);
    const auto moving = worlds_[v.day].place(bodies);
    const SensorModel used = coarseness > 1.0 ? sensor.at_rate(sensor.rate_hz * coarseness) : sensor;
    return render_standing(worlds_[v.day], moving.get(), used, v.T_town_lidar, v.seed);
  }

  std::size_t bin_of(double symmetric) const {
    const double share = (symmetric - o_.min_overlap) / (o_.max_overlap - o_.min_overlap);
    return share < 0.0 || share >= 1.0 ? kBins : static_cast<std::size_t>(share * kBins);
  }

  bool lacks(std::size_t bin) const { return bin < kBins && filled_[bin] < wanted_[bin]; }

  /// Gives up on the bins that stay empty: what they lack is shared out to those that were filled.
  void share_out_the_rest() {
    std::vector<std::size_t> full;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      if (lacks(bin)) {
        wanted_[bin] = filled_[bin];
      } else if (filled_[bin] > 0) {
        full.push_back(bin);
      }
    }
    for (std::size_t k = sample_.pairs.size(); k < o_.pairs && !full.empty(); ++k) {
      ++wanted_[full[k % full.size()]];
    }
  }

  /// Distances to try: half of them spread evenly, half of them closer, where overlap changes fast.
  std::pair<double, double> distance_range(std::size_t trial, Rng& rng) const {
    const double u = rng.uniform();
    const double d =
        trial % 2 == 0 ? 1.5 + u * (o_.max_distance_m - 3.5) : std::exp(u * std::log(0.4 * o_.max_distance_m));
    return {std::max(0.5, d - 1.5), std::min(o_.max_distance_m - 1.5, d + 1.5)};
  }

  std::optional<Candidate> candidate(std::uint64_t number) const {
    Rng rng(task_seed(o_.seed, {71, number}));
    const internal::StreetPlace place = places_.any(rng);
    Candidate c;
    c.source = view(place, rng.below(static_cast<std::uint32_t>(worlds_.size())), false, rng);
    const cloud::OverlapCloud coarse(render(c.source, kTrialCoarseness).points);
    std::vector<View> fitting;
    for (std::size_t trial = 0; trial < kTrials; ++trial) {
      const auto [low, high] = distance_range(trial, rng);
      const internal::StreetPlace other = places_.at_distance(place.position, low, high, rng);
      const View target = view(other, rng.below(static_cast<std::uint32_t>(worlds_.size())), true, rng);
      const cloud::OverlapCloud seen(render(target, kTrialCoarseness).points);
      const Pose motion = target.T_town_lidar.inverse() * c.source.T_town_lidar;
      if (lacks(bin_of(cloud::overlap(coarse, seen, motion).symmetric))) {
        fitting.push_back(target);
      }
    }
    if (fitting.empty()) {
      return std::nullopt;
    }
    c.target = fitting[rng.below(static_cast<std::uint32_t>(fitting.size()))];
    c.T_target_source = c.target.T_town_lidar.inverse() * c.source.T_town_lidar;
    if (c.T_target_source.translation().norm() > o_.max_distance_m) {
      return std::nullopt;
    }
    c.source_cloud = render(c.source, 1.0);
    c.target_cloud = render(c.target, 1.0);
    c.shared = cloud::overlap(c.source_cloud, c.target_cloud, c.T_target_source);
    return c;
  }

  std::size_t add_scan(const View& v, const PointCloud& cloud) {
    sample_.T_town_lidar.push_back(v.T_town_lidar);
    sink_(sample_.T_town_lidar.size() - 1, cloud);
    return sample_.T_town_lidar.size() - 1;
  }

  std::size_t positives(std::size_t round) {
    std::vector<std::optional<Candidate>> candidates(kSources);
    parallel_for(kSources, [&](std::size_t k) { candidates[k] = candidate(round * kSources + k); });
    std::size_t kept = 0;
    for (const auto& c : candidates) {
      const std::size_t bin = c ? bin_of(c->shared.symmetric) : kBins;
      if (lacks(bin)) {
        ++filled_[bin];
        ++kept;
        const std::size_t source = add_scan(c->source, c->source_cloud);
        const std::size_t target = add_scan(c->target, c->target_cloud);
        sample_.pairs.push_back({source, target, c->T_target_source, c->shared.source, c->shared.symmetric});
      }
    }
    return kept;
  }

  bool negative(std::size_t number) {
    Rng rng(task_seed(o_.seed, {72, number}));
    const bool alike = number % 2 == 0;
    auto [here, there] = alike ? places_.alike(rng) : std::pair(places_.any(rng), places_.any(rng));
    if ((here.position - there.position).norm() < 150.0) {
      return false;
    }
    const View a = view(here, 0, false, rng);
    const View b = view(there, rng.below(static_cast<std::uint32_t>(worlds_.size())), true, rng);
    const PointCloud cloud_a = render(a, 1.0);
    const PointCloud cloud_b = render(b, 1.0);
    if (cloud::overlap(cloud_a, cloud_b, b.T_town_lidar.inverse() * a.T_town_lidar).source > kNoOverlap) {
      return false;
    }
    const std::size_t first = add_scan(a, cloud_a);
    const std::size_t second = add_scan(b, cloud_b);
    sample_.negatives.emplace_back(first, second);
    return true;
  }

  const Town& town_;
  PairOptions o_;
  const ScanSink& sink_;
  internal::StreetPlaces places_;
  std::array<SensorModel, 2> sensors_;
  std::vector<World> worlds_;
  std::vector<Traffic> traffic_;
  std::array<std::size_t, kBins> wanted_{};
  std::array<std::size_t, kBins> filled_{};
  PairSample sample_;
};

}  // namespace

void check(const PairOptions& o) {
  require_option(o.pairs >= 1 && o.pairs <= 1000000, "pairs", "must lie between 1 and 1000000");
  require_option(o.days >= 1 && o.days <= 8, "days", "must lie between 1 and 8");
  require_option(o.min_overlap >= 0.02 && o.max_overlap <= 0.98 && o.min_overlap + 0.05 <= o.max_overlap, "min_overlap",
                 "must be at least 0.02 and 0.05 less than max_overlap, which is at most 0.98");
  require_option(o.max_distance_m >= 5.0 && o.max_distance_m <= 200.0, "max_distance_m",
                 "must lie between 5 and 200 metres");
}

PairSample sample_pairs(const Town& town, const PairOptions& options, const ScanSink& sink) {
  check(options);
  return Sampler(town, options, sink).run();
}

}  // namespace loopmark::simulation
