// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/compensation.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/core/parallel.hpp"
#include "loopmark/odometry/odometry.hpp"

namespace loopmark::odometry {
namespace {

constexpr std::size_t kWarmUp = 3;       ///< scans of a window that only fill the local map
constexpr double kLeastMotion_m = 0.08;  ///< a sweep that moves the sensor less is not bent enough to tell
constexpr double kLeastSigmas = 3.0;

/// What one scan showed under one assumption.
struct Sample {
  double residual_m = 0.0;
  double speed_m_s = 0.0;
  bool lost = true;
};

std::vector<Sample> follow(const std::vector<std::size_t>& window, const std::function<Scan(std::size_t)>& read,
                           Compensation assumption, const OdometryOptions& options, const cloud::SweepModel& sweep) {
  Odometry odometry(options, assumption, sweep);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const TrackedScan tracked = odometry.track(read(window[i]));
    odometry.commit(tracked);
    if (i >= kWarmUp) {
      samples.push_back({tracked.tracking_status.residual_m, tracked.velocity.head<3>().norm(),
                         tracked.tracking_status.tracking == Tracking::kLost});
    }
  }
  return samples;
}

double median_of(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double mean_residual(const std::vector<Sample>& samples, const std::vector<std::size_t>& used) {
  double sum = 0.0;
  for (const std::size_t i : used) {
    sum += samples[i].residual_m;
  }
  return sum / static_cast<double>(used.size());
}

/// Mean of (b - a) over its standard error, scan by scan.
double sigmas_between(const std::vector<Sample>& a, const std::vector<Sample>& b,
                      const std::vector<std::size_t>& used) {
  const auto count = static_cast<double>(used.size());
  const double mean = mean_residual(b, used) - mean_residual(a, used);
  double squares = 0.0;
  for (const std::size_t i : used) {
    squares += std::pow(b[i].residual_m - a[i].residual_m - mean, 2);
  }
  const double error = std::sqrt(squares / (count * (count - 1.0)));
  return mean / std::max(error, 1e-12);
}

/// The scans that were followed under every assumption.
std::vector<std::size_t> followed_always(const std::vector<std::vector<Sample>>& samples) {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < samples.front().size(); ++i) {
    if (std::none_of(samples.begin(), samples.end(), [i](const auto& trial) { return trial[i].lost; })) {
      used.push_back(i);
    }
  }
  return used;
}

std::vector<Compensation> assumptions(bool times_given) {
  if (times_given) {
    return {Compensation::kCompensated, Compensation::kRawGivenTimes};
  }
  return {Compensation::kCompensated, Compensation::kRawClockwise, Compensation::kRawCounterClockwise};
}

/// The samples of each assumption, all windows behind each other.
std::vector<std::vector<Sample>> follow_all(const std::vector<std::vector<std::size_t>>& windows,
                                            const std::function<Scan(std::size_t)>& read,
                                            const std::vector<Compensation>& tried, const OdometryOptions& options,
                                            const cloud::SweepModel& sweep) {
  std::vector<std::vector<Sample>> runs(tried.size() * windows.size());
  parallel_for(runs.size(), [&](std::size_t k) {
    runs[k] = follow(windows[k % windows.size()], read, tried[k / windows.size()], options, sweep);
  });
  std::vector<std::vector<Sample>> samples(tried.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    std::vector<Sample>& all = samples[k / windows.size()];
    all.insert(all.end(), runs[k].begin(), runs[k].end());
  }
  return samples;
}

}  // namespace

CompensationMeasurement measure_compensation(const std::vector<std::vector<std::size_t>>& windows,
                                             const std::function<Scan(std::size_t)>& read, bool times_given,
                                             const OdometryOptions& options, const cloud::SweepModel& sweep) {
  CompensationMeasurement result;
  if (windows.empty()) {
    result.reason = "no stretch of consecutive scans";
    return result;
  }
  const std::vector<Compensation> tried = assumptions(times_given);
  const std::vector<std::vector<Sample>> samples = follow_all(windows, read, tried, options, sweep);
  const std::vector<std::size_t> used = followed_always(samples);
  if (used.size() < 5) {
    result.reason = "the sensor cannot be followed from scan to scan";
    return result;
  }
  std::vector<double> speeds;
  for (const std::size_t i : used) {
    speeds.push_back(samples.front()[i].speed_m_s);
  }
  result.speed_m_s = median_of(std::move(speeds));
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < tried.size(); ++k) {
    result.trials.push_back({tried[k], mean_residual(samples[k], used)});
    order.push_back(k);
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return result.trials[a].residual_m < result.trials[b].residual_m; });
  result.sigmas = sigmas_between(samples[order[0]], samples[order[1]], used);
  if (result.speed_m_s * sweep.period_s < kLeastMotion_m) {
    result.reason = "the sensor hardly moves";
  } else if (result.sigmas < kLeastSigmas) {
    result.reason = "no assumption fits clearly best";
  } else {
    result.verdict = tried[order[0]];
  }
  return result;
}

const char* compensation_name(Compensation compensation) {
  switch (compensation) {
    case Compensation::kCompensated:
      return "motion-compensated";
    case Compensation::kRawGivenTimes:
      return "raw, with the time of each point";
    case Compensation::kRawClockwise:
      return "raw, sweeping clockwise";
    case Compensation::kRawCounterClockwise:
      return "raw, sweeping counter-clockwise";
    default:
      return "unknown";
  }
}

}  // namespace loopmark::odometry
