// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "loopmark/io/log_report.hpp"

namespace loopmark::io {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kNear_m = 2.0;  ///< nearer points belong to the carrier, or their elevation is no beam's

struct Angles {
  std::vector<double> azimuth;
  std::vector<double> elevation_deg;
};

Angles angles_of(const PointCloud& cloud) {
  Angles angles;
  for (const Eigen::Vector3f& p : cloud.points) {
    const double flat = std::hypot(static_cast<double>(p.x()), static_cast<double>(p.y()));
    if (flat > kNear_m) {
      angles.azimuth.push_back(std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x())));
      angles.elevation_deg.push_back(std::atan2(static_cast<double>(p.z()), flat) * kDegrees);
    }
  }
  return angles;
}

/// The value that a share of the values does not exceed.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return 0.0;
  }
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// Rings that hold at least a thousandth of the points.
std::size_t beams_by_rings(const std::vector<std::uint16_t>& rings) {
  std::map<std::uint16_t, std::size_t> counts;
  for (const std::uint16_t ring : rings) {
    ++counts[ring];
  }
  return static_cast<std::size_t>(std::count_if(
      counts.begin(), counts.end(), [&](const auto& entry) { return 1000 * entry.second >= rings.size(); }));
}

/// Where files hold ring after ring, the azimuth turns once for each beam.
std::size_t beams_by_order(const std::vector<double>& azimuth) {
  double turned = 0.0;
  std::size_t forward = 0;
  for (std::size_t i = 1; i < azimuth.size(); ++i) {
    const double step = std::remainder(azimuth[i] - azimuth[i - 1], 2.0 * std::numbers::pi);
    turned += step;
    forward += step > 0.0 ? 1 : 0;
  }
  const double share = azimuth.empty() ? 0.5 : static_cast<double>(forward) / static_cast<double>(azimuth.size());
  const bool one_way = share > 0.8 || share < 0.2;
  return one_way ? static_cast<std::size_t>(std::llround(std::abs(turned) / (2.0 * std::numbers::pi))) : 0;
}

/// Peaks of the histogram of elevations; 0 unless the points lie in crisp rows.
std::size_t beams_by_elevation(const std::vector<double>& elevation_deg) {
  constexpr double kBin_deg = 0.05;
  constexpr std::size_t kBins = 2400;  // +-60 degrees
  std::vector<std::size_t> bins(kBins, 0);
  for (const double elevation : elevation_deg) {
    const double bin = (elevation + 60.0) / kBin_deg;
    if (bin >= 0.0 && bin < static_cast<double>(kBins)) {
      ++bins[static_cast<std::size_t>(bin)];
    }
  }
  const std::size_t floor = elevation_deg.size() / 2000;
  std::size_t peaks = 0;
  std::size_t in_rows = 0;
  for (std::size_t i = 0; i < kBins;) {
    std::size_t sum = 0;
    const std::size_t begin = i;
    for (; i < kBins && bins[i] > 0; ++i) {
      sum += bins[i];
    }
    if (sum > floor && i - begin <= 4) {
      ++peaks;
      in_rows += sum;
    }
    ++i;
  }
  return 10 * in_rows > 9 * elevation_deg.size() ? peaks : 0;
}

/// The usual number of beams next to `counted`: a ring may see nothing, or be cut in two.
std::size_t usual_number(std::size_t counted) {
  for (const std::size_t usual : {8U, 16U, 32U, 40U, 64U, 80U, 128U}) {
    if (10 * counted >= 9 * usual && 16 * counted <= 17 * usual) {
      return usual;
    }
  }
  return counted;
}

struct KnownSensor {
  const char* name;
  std::size_t beams;
  double lowest_deg;
  double highest_deg;
};

constexpr std::array kKnownSensors = {
    KnownSensor{"VLP-16", 16, -15.0, 15.0},    KnownSensor{"HDL-32E", 32, -30.7, 10.7},
    KnownSensor{"VLP-32C", 32, -25.0, 15.0},   KnownSensor{"Pandar40", 40, -16.0, 7.0},
    KnownSensor{"HDL-64E", 64, -24.8, 2.0},    KnownSensor{"OS1-64", 64, -16.6, 16.6},
    KnownSensor{"OS1-64", 64, -22.5, 22.5},    KnownSensor{"OS0-64", 64, -45.0, 45.0},
    KnownSensor{"OS2-64", 64, -11.3, 11.3},    KnownSensor{"OS0-128", 128, -45.0, 45.0},
    KnownSensor{"OS1-128", 128, -22.5, 22.5},  KnownSensor{"VLS-128", 128, -25.0, 15.0},
    KnownSensor{"Pandar128", 128, -25.0, 15.0}};

/// The known sensor whose field of view is nearest, if its edges are within 6 degrees (edge beams may see nothing).
std::string name_of(const SensorGuess& guess) {
  std::string name;
  double nearest = 6.0;
  for (const KnownSensor& sensor : kKnownSensors) {
    const double miss =
        std::max(std::abs(sensor.lowest_deg - guess.lowest_deg), std::abs(sensor.highest_deg - guess.highest_deg));
    if (sensor.beams == guess.beams && miss < nearest) {
      nearest = miss;
      name = sensor.name;
    }
  }
  return name;
}

}  // namespace

SensorGuess guess_sensor(const PointCloud& cloud) {
  const Angles angles = angles_of(cloud);
  SensorGuess guess;
  std::vector<double> ranges;
  for (const Eigen::Vector3f& p : cloud.points) {
    ranges.push_back(static_cast<double>(p.norm()));
  }
  guess.farthest_m = quantile(std::move(ranges), 0.999);
  guess.lowest_deg = quantile(angles.elevation_deg, 0.002);
  guess.highest_deg = quantile(angles.elevation_deg, 0.998);
  if (!cloud.ring.empty()) {
    guess.beams = beams_by_rings(cloud.ring);
    guess.beams_from = "rings";
  } else if (const std::size_t by_order = beams_by_order(angles.azimuth); by_order >= 8 && by_order <= 256) {
    guess.beams = by_order;
    guess.beams_from = "order of the points";
  } else if (const std::size_t by_elevation = beams_by_elevation(angles.elevation_deg); by_elevation >= 8) {
    guess.beams = by_elevation;
    guess.beams_from = "elevations";
  }
  guess.beams = usual_number(guess.beams);
  guess.name = name_of(guess);
  return guess;
}

StampFacts examine_stamps(const std::vector<double>& stamps_s) {
  StampFacts facts;
  std::vector<double> spacings;
  for (std::size_t i = 1; i < stamps_s.size(); ++i) {
    const double spacing = stamps_s[i] - stamps_s[i - 1];
    if (spacing > 0.0) {
      spacings.push_back(spacing);
    } else {
      (spacing == 0.0 ? facts.repeated : facts.backwards).push_back(i);
    }
  }
  if (spacings.empty()) {
    return facts;
  }
  const auto [least, most] = std::minmax_element(stamps_s.begin(), stamps_s.end());
  facts.duration_s = *most - *least;
  const double median = quantile(spacings, 0.5);
  facts.rate_hz = 1.0 / median;
  const auto near = std::count_if(spacings.begin(), spacings.end(),
                                  [median](double s) { return std::abs(s - median) < 0.2 * median; });
  facts.regular = 10 * near >= 9 * static_cast<std::ptrdiff_t>(spacings.size());
  for (std::size_t i = 1; facts.regular && i < stamps_s.size(); ++i) {
    if (stamps_s[i] - stamps_s[i - 1] > 1.5 * median) {
      facts.gaps.push_back({i, stamps_s[i] - stamps_s[i - 1]});
    }
  }
  return facts;
}

}  // namespace loopmark::io
