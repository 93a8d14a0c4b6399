// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "speed_profile.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/core/random.hpp"

namespace loopmark::simulation::internal {

SpeedProfile::SpeedProfile(const LanePath& path, const RoadNetwork& roads, const Limits& limits, std::uint64_t seed) {
  Rng rng(seed);
  const std::size_t count = path.points.size();
  speed_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double bend = std::abs(path.curvature(kPathStep * static_cast<double>(i)));
    const double limit = limits.speed_factor * roads.edges[path.edge[i]].speed_limit_mps;
    speed_[i] = std::min(limit, std::sqrt(limits.sideways_mps2 / std::max(bend, 1e-6)));
  }
  std::vector<double> halts(count, 0.0);
  // Halts lie where a street ends, as at a junction that has to be waited for.
  for (std::size_t i = 80; i + 80 < count && limits.halt_every_m > 0.0; ++i) {
    const double street = 80.0;
    if (path.edge[i] != path.edge[i + 40] && path.edge[i - 1] == path.edge[i + 39] &&
        rng.uniform() < street / limits.halt_every_m) {
      halts[i] = rng.uniform(1.0, 6.0);
      speed_[i] = 0.0;
    }
  }
  if (limits.from_standstill) {
    speed_.front() = 0.0;
  }
  for (std::size_t i = 1; i < count; ++i) {
    speed_[i] =
        std::min(speed_[i], std::sqrt(speed_[i - 1] * speed_[i - 1] + 2.0 * limits.accelerate_mps2 * kPathStep));
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    speed_[i] = std::min(speed_[i], std::sqrt(speed_[i + 1] * speed_[i + 1] + 2.0 * limits.brake_mps2 * kPathStep));
  }
  double time = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    time += i == 0 ? 0.0 : 2.0 * kPathStep / (speed_[i - 1] + speed_[i]);
    arrive_.push_back(time);
    time += halts[i];
    leave_.push_back(time);
  }
}

std::size_t SpeedProfile::sample_at(double time_s) const {
  const auto after = std::upper_bound(leave_.begin(), leave_.end(), time_s);
  const std::size_t i = after == leave_.begin() ? 0 : static_cast<std::size_t>(after - leave_.begin()) - 1;
  return std::min(i, speed_.size() - 2);
}

double SpeedProfile::acceleration(double time_s) const {
  const std::size_t i = sample_at(time_s);
  if (time_s < 0.0 || time_s > arrive_.back() || time_s >= arrive_[i + 1]) {
    return 0.0;
  }
  return (speed_[i + 1] * speed_[i + 1] - speed_[i] * speed_[i]) / (2.0 * kPathStep);
}

double SpeedProfile::speed(double time_s) const {
  if (time_s < 0.0) {
    return speed_.front();
  }
  const std::size_t i = sample_at(time_s);
  if (time_s >= arrive_[i + 1]) {  // halting at the next sample, or past the end
    return speed_[i + 1];
  }
  return speed_[i] + acceleration(time_s) * (time_s - leave_[i]);
}

double SpeedProfile::distance(double time_s) const {
  if (time_s < 0.0) {
    return time_s * speed_.front();
  }
  const std::size_t i = sample_at(time_s);
  const double from = kPathStep * static_cast<double>(i);
  if (time_s >= arrive_[i + 1]) {
    const bool past = i + 2 == speed_.size();
    return from + kPathStep + (past ? (time_s - arrive_.back()) * speed_.back() : 0.0);
  }
  const double since = time_s - leave_[i];
  return from + speed_[i] * since + 0.5 * acceleration(time_s) * since * since;
}

}  // namespace loopmark::simulation::internal
