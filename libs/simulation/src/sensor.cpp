// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "loopmark/core/error.hpp"

namespace loopmark::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<double> even_fan(int lasers, double low_deg, double high_deg) {
  std::vector<double> fan;
  for (int i = 0; i < lasers; ++i) {
    fan.push_back(kDegree * (low_deg + (high_deg - low_deg) * i / (lasers - 1)));
  }
  return fan;
}

/// Roof, bonnet and a roof bar of an estate car below a sensor that stands half a metre above the roof.
std::vector<EgoBox> car_below(double height) {
  const double bonnet = 0.78 - height;
  return {{{-1.65, -0.55, -0.6}, {0.7, 0.55, -0.5}},
          {{1.3, -0.75, bonnet - 0.2}, {2.45, 0.75, bonnet}},
          {{-1.05, -0.6, -0.5}, {-1.0, 0.6, -0.4}}};
}

SensorModel hdl64e() {
  SensorModel s;
  s.label = "Velodyne HDL-64E";
  // Lower block: 32 lasers half a degree apart; upper block: 32 lasers a third of a degree apart.
  s.elevation_rad = even_fan(32, -24.33, -8.83);
  const std::vector<double> upper = even_fan(32, -8.33, 2.0);
  s.elevation_rad.insert(s.elevation_rad.end(), upper.begin(), upper.end());
  s.columns = 2083;
  for (int i = 0; i < 64; ++i) {
    s.fire_offset_s.push_back(1.2e-6 * (i % 32));
  }
  s.max_range_m = 120.0;
  s.reach_10_m = 60.0;
  return s;
}

SensorModel hdl32e() {
  SensorModel s;
  s.label = "Velodyne HDL-32E";
  s.elevation_rad = even_fan(32, -30.67, 10.67);
  s.columns = 2170;
  for (int i = 0; i < 32; ++i) {
    s.fire_offset_s.push_back(1.152e-6 * (i % 2 == 0 ? i / 2 * 2 : i / 2 * 2 + 1));
  }
  s.max_range_m = 100.0;
  s.reach_10_m = 50.0;
  s.height_m = 1.84;
  return s;
}

SensorModel vlp16() {
  SensorModel s;
  s.label = "Velodyne VLP-16";
  s.elevation_rad = even_fan(16, -15.0, 15.0);
  s.columns = 1808;
  for (int i = 0; i < 16; ++i) {
    // Lasers fire in the order -15, 1, -13, 3, ...: a laser below the horizon is followed by one above.
    s.fire_offset_s.push_back(2.304e-6 * (i < 8 ? 2 * i : 2 * (i - 8) + 1));
  }
  s.noise_m = 0.015;
  s.reach_10_m = 50.0;
  s.min_range_m = 0.5;
  return s;
}

SensorModel os1_64() {
  SensorModel s;
  s.label = "Ouster OS1-64";
  s.elevation_rad = even_fan(64, -16.6, 16.6);
  s.columns = 1024;
  s.fire_offset_s.assign(64, 0.0);  // all lasers fire at once
  s.max_range_m = 120.0;
  s.noise_m = 0.025;
  s.reach_10_m = 45.0;
  s.min_range_m = 0.5;
  s.blocked_centre_rad = std::numbers::pi;
  s.blocked_width_rad = 70.0 * kDegree;
  s.height_m = 1.8;
  return s;
}

}  // namespace

SensorModel SensorModel::at_rate(double hz) const {
  SensorModel other = *this;
  other.columns = static_cast<int>(std::lround(columns * rate_hz / hz));
  other.rate_hz = hz;
  return other;
}

std::vector<std::string> sensor_names() { return {"hdl64e", "hdl32e", "vlp16", "os1-64"}; }

SensorModel sensor_model(const std::string& name) {
  SensorModel s;
  if (name == "hdl64e") {
    s = hdl64e();
  } else if (name == "hdl32e") {
    s = hdl32e();
  } else if (name == "vlp16") {
    s = vlp16();
  } else if (name == "os1-64") {
    s = os1_64();
  } else {
    throw InputError("unknown sensor \"" + name + "\" (choose from hdl64e, hdl32e, vlp16, os1-64)");
  }
  s.name = name;
  s.ego = car_below(s.height_m);
  return s;
}

double reflectance(Surface surface, double cos_incidence) {
  struct Look {
    double diffuse, mirror;
  };
  constexpr std::array<Look, static_cast<std::size_t>(Material::kCount)> kLooks = {{
      {0.20, 0.0},
      {0.30, 0.0},
      {0.35, 0.0},
      {0.35, 0.0},
      {0.55, 0.0},
      {0.42, 0.0},
      {0.25, 0.0},
      {0.03, 0.5},
      {0.30, 0.6},
      {0.30, 0.5},
      {0.06, 0.0},
      {0.25, 0.0},
      {0.40, 0.0},
      {0.35, 0.0},
      {1.6, 0.0},
      {0.35, 0.0},
      {0.01, 0.3},
  }};
  const Look look = kLooks[static_cast<std::size_t>(surface.material)];
  return look.diffuse * (0.6 + 0.8 * surface.shade / 255.0) + look.mirror * std::pow(cos_incidence, 60.0);
}

double detection_probability(const SensorModel& sensor, double rho, double cos_incidence, double range_m) {
  constexpr double kRoughness = 0.25;  // share of the echo that does not weaken with incidence
  constexpr double kBestCase = 0.995;
  const double echo = rho * (kRoughness + (1.0 - kRoughness) * cos_incidence) / (range_m * range_m);
  const double needed = 0.1 / (sensor.reach_10_m * sensor.reach_10_m);
  const double ratio = echo / needed;
  return kBestCase / (1.0 + 1.0 / (ratio * ratio * ratio));
}

}  // namespace loopmark::simulation
