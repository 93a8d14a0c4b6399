// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/simulation/drive_writer.hpp"

namespace loopmark::app {
namespace {

using namespace simulation;

struct SimulateArguments {
  std::filesystem::path output;
  TownOptions town;
  DriveOptions drive;
  WriteOptions write;
};

constexpr const char* kExamples = R"(Examples:
  loopmark simulate -o drives/day1                                   1 km tour, HDL-64E, raw sweeps
  loopmark simulate -o drives/day2 --day 2 --direction reverse       the same town on another day, driven the other way
  loopmark simulate -o drives/vlp --sensor vlp16 --format pcd        with the time and ring of every point
  loopmark simulate -o drives/far --town 7 --route open --length 1500  another town, over the river and back
The log (velodyne/, times.txt, poses.txt, calib.txt, sweep.txt, revisits.csv, town.json) can be read by loopmark map.
The truth in poses.txt is the sensor's pose at the stamp of each scan, the moment it looks forward; the time of a point is
relative to that stamp. The same options give the same bytes.)";

void declare(CLI::App& command, SimulateArguments& a) {
  command.add_option("-o,--output", a.output, "folder to make; must not exist")->required();
  command.add_option("--town", a.town.seed, "seed of the town")->capture_default_str();
  command.add_option("--length", a.drive.length_m, "driven distance, metres")->capture_default_str();
  command.add_option("--sensor", a.drive.sensor, "hdl64e, hdl32e, vlp16, os1-64")->capture_default_str();
  command.add_option("--day", a.drive.day, "other days, other parked cars and traffic")->capture_default_str();
  command.add_option("--route", a.drive.route, "tour, explore, twins, open")->capture_default_str();
  command.add_option("--lane", a.drive.lane, "right, centre, left")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Lane>{{"right", Lane::kRight}, {"centre", Lane::kCentre}, {"left", Lane::kLeft}}));
  command.add_option("--direction", a.drive.reverse, "forward, or reverse: the route from its end")
      ->transform(CLI::CheckedTransformer(std::map<std::string, bool>{{"forward", false}, {"reverse", true}}));
  command.add_option("--rate", a.drive.rate_hz, "sweeps a second; 0: the sensor's own")->capture_default_str();
  command.add_option("--seed", a.drive.seed, "seed of noise, speeds, halts and traffic")->capture_default_str();
  command.add_option("--format", a.write.format, "kitti (.bin) or pcd (with ring and time of each point)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, LogFormat>{{"kitti", LogFormat::kKitti}, {"pcd", LogFormat::kPcd}}));
  command.add_flag("--compensated", a.write.compensated, "write scans in the frame of their stamp (motion-compensated)");
  command.add_flag("--from-standstill", a.drive.from_standstill, "start from a halt; else the log starts while moving");
  command.footer(kExamples);
}

int simulate(const SimulateArguments& a) {
  check(a.drive);
  const Town town = make_town(a.town);
  const Drive drive(town, a.drive);
  const World world(town, a.drive.day);
  const Stopwatch watch;
  const WrittenLog log = write_drive(world, town, drive, a.output, a.write);
  const double seconds = watch.seconds();
  const double rays = static_cast<double>(drive.sensor().rays_per_sweep() * log.scans);
  std::printf("%s: %zu scans (%s), %.0f m, %zu revisits, %.1f million points\n", a.output.c_str(), log.scans,
              drive.sensor().label.c_str(), log.length_m, drive.revisits().size(), 1e-6 * static_cast<double>(log.points));
  std::printf("%.1f s: %.1f scans/s, %.2f million rays/s\n", seconds, static_cast<double>(log.scans) / seconds,
              1e-6 * rays / seconds);
  return 0;
}

}  // namespace

Action set_up_simulate(CLI::App& command, const Globals& /*globals*/) {
  auto arguments = std::make_shared<SimulateArguments>();
  declare(command, *arguments);
  return [arguments] { return simulate(*arguments); };
}

}  // namespace loopmark::app
