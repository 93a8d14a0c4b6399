// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The models' lasers in the order in which a packet holds them.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "velodyne.hpp"

namespace loopmark::packets::internal {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// Rings are counted from the lowest beam.
void number_rings(std::vector<Laser>& lasers) {
  for (Laser& laser : lasers) {
    laser.ring = static_cast<std::uint16_t>(std::count_if(
        lasers.begin(), lasers.end(), [&](const Laser& other) { return other.elevation_rad < laser.elevation_rad; }));
  }
}

std::vector<Laser> lasers_of(const std::vector<double>& elevations_deg, const std::vector<double>& azimuths_deg = {}) {
  std::vector<Laser> lasers(elevations_deg.size());
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    lasers[i].elevation_rad = elevations_deg[i] * kRadians;
    lasers[i].azimuth_rad = azimuths_deg.empty() ? 0.0 : azimuths_deg[i] * kRadians;
  }
  number_rings(lasers);
  return lasers;
}

VelodyneModel vlp16() {
  return {"VLP-16", 0.002, 2, 55.296e-6,
          2.304e-6, 1,     1, lasers_of({-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15})};
}

VelodyneModel hdl32e() {
  std::vector<double> elevations;
  for (int i = 0; i < 16; ++i) {  // the lower half and the upper one take turns, 4/3 degrees apart
    elevations.push_back(-30.67 + i * 4.0 / 3.0);
    elevations.push_back(-9.33 + i * 4.0 / 3.0);
  }
  return {"HDL-32E", 0.002, 1, 46.08e-6, 1.152e-6, 1, 1, lasers_of(elevations)};
}

VelodyneModel vlp32c() {
  return {"VLP-32C",
          0.004,
          1,
          55.296e-6,
          2.304e-6,
          2,
          1,
          lasers_of({-25.0,  -1.0,   -1.667, -15.639, -11.31, 0.0,    -0.667, -8.843, -7.254, 0.333,  -0.333,
                     -6.148, -5.333, 1.333,  0.667,   -4.0,   -4.667, 1.667,  1.0,    -3.667, -3.333, 3.333,
                     2.333,  -2.667, -3.0,   7.0,     4.667,  -2.333, -2.0,   15.0,   10.333, -1.333},
                    {1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
                     1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4})};
}

/// These are not made to nominal angles: each has its own file.
VelodyneModel vls128() { return {"VLS-128", 0.004, 1, 53.3e-6, 2.665e-6, 8, 4, {}, 8}; }
VelodyneModel hdl64e() { return {"HDL-64E", 0.002, 1, 48.0e-6, 0.0, 64, 2, {}}; }

/// The lasers of the YAML file that Velodyne's ROS driver reads.
std::vector<Laser> read_calibration(const std::filesystem::path& file) {
  try {
    std::vector<Laser> lasers;
    for (const YAML::Node& entry : YAML::LoadFile(file.string())["lasers"]) {
      const auto id = entry["laser_id"].as<std::size_t>();
      if (id >= 256) {
        throw InputError(file.string(), std::to_string(entry.Mark().line + 1), "laser_id is above 255");
      }
      lasers.resize(std::max(lasers.size(), id + 1));
      lasers[id].elevation_rad = entry["vert_correction"].as<double>();
      // The files count the rotation's corrections against the clock.
      lasers[id].azimuth_rad = -entry["rot_correction"].as<double>(0.0);
      lasers[id].distance_m = entry["dist_correction"].as<double>(0.0);
      lasers[id].vertical_m = entry["vert_offset_correction"].as<double>(0.0);
      lasers[id].horizontal_m = entry["horiz_offset_correction"].as<double>(0.0);
    }
    if (lasers.empty()) {
      throw InputError(file.string(), "", "no list 'lasers': this is no calibration of a Velodyne sensor");
    }
    number_rings(lasers);
    return lasers;
  } catch (const YAML::Exception& problem) {
    throw InputError(file.string(), std::to_string(problem.mark.line + 1), problem.msg);
  }
}

std::optional<VelodyneModel> model_of(std::string_view packet) {
  switch (static_cast<unsigned char>(packet[VelodyneDecoder::kBytes - 1])) {
    case 0x21:
      return hdl32e();
    case 0x22:
    case 0x24:  // Puck Hi-Res: the calibration file tells its angles
      return vlp16();
    case 0x28:
      return vlp32c();
    case 0xA1:
    case 0x63:
      return vls128();
    default:
      break;
  }
  // HDL-64E sends other things in the last bytes, but two kinds of blocks.
  return packet.substr(100, 2) == "\xff\xdd" ? std::optional(hdl64e()) : std::nullopt;
}

}  // namespace

std::unique_ptr<PacketDecoder> make_velodyne(std::string_view packet, const std::filesystem::path& calibration) {
  if (packet.size() != VelodyneDecoder::kBytes || packet.substr(0, 2) != "\xff\xee") {
    return nullptr;
  }
  std::optional<VelodyneModel> model = model_of(packet);
  if (!model) {
    return nullptr;
  }
  if (!calibration.empty()) {
    model->lasers = read_calibration(calibration);
  }
  const std::size_t needed =
      32U * static_cast<std::size_t>(model->banks) / static_cast<std::size_t>(model->firings_in_block);
  if (model->lasers.size() != needed) {
    const std::string problem = calibration.empty()
                                    ? "it has no angles of its own"
                                    : "its file has " + std::to_string(model->lasers.size()) + " lasers";
    throw InputError(calibration.string(), "",
                     std::string("packets of a Velodyne ") + model->name + " with " + std::to_string(needed) +
                         " lasers, but " + problem,
                     "put the sensor's calibration beside the log as calibration.yaml");
  }
  return std::make_unique<VelodyneDecoder>(std::move(*model));
}

}  // namespace loopmark::packets::internal
