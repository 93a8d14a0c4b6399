// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "hesai.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "point_sink.hpp"

namespace loopmark::packets::internal {
namespace {

constexpr double kRounding_m = 1e-6;  // ranges are whole numbers of a unit; its multiples are not exact
constexpr double kRadians = std::numbers::pi / 180.0;

HesaiModel xt(std::size_t lasers) {
  HesaiModel m{lasers == 32 ? "PandarXT-32" : "PandarXT-16", 12, 8, lasers, 4, 10, 19, 24, 0.004, 50e-6, 1.512e-6, {}};
  m.least_range_m = 0.05;
  m.beams.resize(lasers);
  for (std::size_t i = 0; i < lasers; ++i) {  // evenly from 15 degrees down
    m.beams[i].elevation_rad = (15.0 - static_cast<double>(i) * (lasers == 32 ? 1.0 : 2.0)) * kRadians;
  }
  return m;
}

HesaiModel qt64() { return {"PandarQT-64", 12, 4, 64, 4, 16, 12, 24, 0.004, 166.67e-6, 2.31e-6, {}, 0.1}; }
HesaiModel pandar64() { return {"Pandar64", 8, 6, 64, 3, 14, 10, 22, 0.004, 55.56e-6, 0.0, {}, 0.3}; }
HesaiModel pandar40p() { return {"Pandar40P", 0, 10, 40, 3, 14, 10, 22, 0.004, 55.56e-6, 0.0, {}, 0.3}; }

unsigned byte_at(std::string_view bytes, std::size_t at) {
  return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0;
}

std::optional<HesaiModel> model_of(std::string_view packet) {
  if (packet.substr(0, 2) == "\xff\xee" && (packet.size() == 1262 || packet.size() == 1266)) {
    return pandar40p();
  }
  if (packet.substr(0, 2) != "\xee\xff") {
    return std::nullopt;
  }
  if (byte_at(packet, 2) == 64 && byte_at(packet, 3) == 6) {
    return pandar64();
  }
  if (byte_at(packet, 2) == 3 && byte_at(packet, 6) == 64 && byte_at(packet, 7) == 4) {
    return qt64();
  }
  const unsigned lasers = byte_at(packet, 6);
  return byte_at(packet, 2) == 6 && (lasers == 16 || lasers == 32) ? std::optional(xt(lasers)) : std::nullopt;
}

/// "Laser id,Elevation,Azimuth" with a header line, degrees.
std::vector<Laser> read_calibration(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<Laser> beams;
  std::size_t number_of_line = 0;
  for (std::string line; std::getline(in, line) && number_of_line < 1000;) {
    ++number_of_line;
    std::array<double, 3> values{};
    std::size_t count = 0;
    const char* at = line.data();
    const char* end = line.data() + line.size();
    while (count < 3 && at < end) {
      const auto [next, error] = std::from_chars(at, end, values[count]);
      if (error != std::errc()) {
        break;
      }
      ++count;
      at = std::find(next, end, ',') + (std::find(next, end, ',') == end ? 0 : 1);
    }
    if (count == 0) {
      continue;  // the header
    }
    if (count < 3 || values[0] < 1.0 || values[0] > 256.0) {
      throw InputError(file.string(), std::to_string(number_of_line), "is no line 'Laser id,Elevation,Azimuth'");
    }
    const auto id = static_cast<std::size_t>(values[0]);
    beams.resize(std::max(beams.size(), id));
    beams[id - 1].elevation_rad = values[1] * kRadians;
    beams[id - 1].azimuth_rad = values[2] * kRadians;
  }
  return beams;
}

}  // namespace

bool HesaiDecoder::accepts(std::string_view bytes) const {
  const auto model = model_of(bytes);
  return model && model->lasers == model_.lasers && model->header == model_.header &&
         bytes.size() >= tail_at() + model_.tail;
}

/// Two returns of the same firing stand in neighbouring blocks; so does a mode with three.
bool HesaiDecoder::dual(std::string_view bytes) const {
  const unsigned mode = byte_at(bytes, tail_at() + model_.tail_mode);
  return mode == 0x39 || mode == 0x3B || mode == 0x3C;
}

std::optional<std::size_t> HesaiDecoder::cut(std::string_view bytes, CutState& state) const {
  return cut_by_angle(
      model_.blocks, [&](std::size_t block) { return 0.01 * number<std::uint16_t>(bytes, block_at(block)); }, state);
}

void HesaiDecoder::decode(const Packet& packet, std::size_t begin, std::size_t end, SweepCloud& sweep) const {
  start_sweep(sweep, packet.time_ns, 1e-6 * number<std::uint32_t>(packet.bytes, tail_at() + model_.tail_time));
  for (std::size_t block = begin; block < std::min(end, model_.blocks); ++block) {
    decode_block(packet, block, sweep);
  }
}

void HesaiDecoder::decode_block(const Packet& packet, std::size_t block, SweepCloud& sweep) const {
  const double packet_s =
      sensor_seconds(sweep, 1e-6 * number<std::uint32_t>(packet.bytes, tail_at() + model_.tail_time), 1.0);
  const bool two = dual(packet.bytes);
  const double block_s = packet_s + static_cast<double>(two ? block / 2 : block) * model_.block_s;
  // The maker's frame, in which its driver publishes and mountings are given: y forward, x to the right.
  const double azimuth = (0.01 * number<std::uint16_t>(packet.bytes, block_at(block)) - 90.0) * kRadians;
  for (std::size_t i = 0; i < model_.lasers; ++i) {
    const std::size_t at = block_at(block) + 2 + i * model_.return_bytes;
    const auto raw = number<std::uint16_t>(packet.bytes, at);
    if (raw * model_.distance_unit_m < std::max(model_.least_range_m, model_.distance_unit_m) - kRounding_m) {
      ++sweep.without_echo;
      continue;
    }
    if (two && block % 2 == 1 &&
        same_echo(number<std::uint16_t>(packet.bytes, at - block_bytes()), raw, model_.distance_unit_m)) {
      continue;
    }
    add_point(sweep, model_.beams[i], azimuth, raw * model_.distance_unit_m, byte_at(packet.bytes, at + 2),
              block_s + static_cast<double>(i) * model_.laser_step_s);
  }
}

std::unique_ptr<PacketDecoder> make_hesai(std::string_view packet, const std::filesystem::path& calibration) {
  std::optional<HesaiModel> model = model_of(packet);
  if (!model || !HesaiDecoder(*model).accepts(packet)) {
    return nullptr;
  }
  if (!calibration.empty()) {
    model->beams = read_calibration(calibration);
  }
  if (model->beams.size() != model->lasers) {
    throw InputError(calibration.string(), "",
                     std::string("packets of a Hesai ") + model->name + ", which needs the angles of its " +
                         std::to_string(model->lasers) + " lasers" +
                         (calibration.empty() ? "" : "; this file has " + std::to_string(model->beams.size())),
                     "put the sensor's angles beside the log as calibration.csv (Laser id,Elevation,Azimuth)");
  }
  for (Laser& beam : model->beams) {
    beam.ring = static_cast<std::uint16_t>(std::count_if(model->beams.begin(), model->beams.end(), [&](const Laser& b) {
      return b.elevation_rad < beam.elevation_rad;
    }));
  }
  return std::make_unique<HesaiDecoder>(std::move(*model));
}

}  // namespace loopmark::packets::internal
