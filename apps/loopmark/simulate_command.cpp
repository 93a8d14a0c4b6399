// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/simulation/drive_writer.hpp"
#include "simulate_pairs.hpp"

namespace loopmark::app {
namespace {

using namespace simulation;

struct SimulateArguments {
  std::filesystem::path output;
  TownOptions town;
  DriveOptions drive;
  WriteOptions write;
  PairOptions pairs;
  std::size_t towns = 1;
  bool only_pairs = false;
};

constexpr const char* kExamples = R"(Examples:
  loopmark simulate -o drives/day1                                   1 km tour, HDL-64E, raw sweeps
  loopmark simulate -o drives/day2 --day 2 --direction reverse       the same town on another day, driven the other way
  loopmark simulate -o drives/vlp --sensor vlp16 --format pcd        with the time and ring of every point
  loopmark simulate -o drives/far --town 7 --route open --length 1500  another town, over the river and back
  loopmark simulate --pairs 500 --towns 5 -o pairs/hdl64e            a balanced set of scan pairs with exact motions
  loopmark simulate --pairs 100 --sensor hdl64e --sensor-b vlp16 -o pairs/cross    one sensor against another
The log (velodyne/, times.txt, poses.txt, calib.txt, sweep.txt, revisits.csv, town.json) can be read by loopmark map.
The truth in poses.txt is the sensor's pose at the stamp of each scan, the moment it looks forward; the time of a point is
relative to that stamp. The same options give the same bytes.)";

/// An option whose values are words; the help lists the words only.
template <class Enum>
void add_choice(CLI::App& command, const std::string& name, Enum& value, const std::string& help,
                const Choices<Enum>& choices) {
  std::vector<std::string> words;
  for (const auto& [word, unused] : choices) {
    words.push_back(word);
  }
  command
      .add_option_function<std::string>(
          name,
          [&value, choices](const std::string& given) {
            for (const auto& [word, meaning] : choices) {
              value = given == word ? meaning : value;
            }
          },
          help)
      ->check(CLI::IsMember(words))
      ->type_name("");
}

void declare(CLI::App& command, SimulateArguments& a) {
  command.add_option("-o,--output", a.output, "folder to make; must not exist")->required();
  command.add_option("--town", a.town.seed, "seed of the town")->capture_default_str();
  command.add_option("--length", a.drive.length_m, "driven distance, metres")->capture_default_str();
  command.add_option("--sensor", a.drive.sensor, "hdl64e, hdl32e, vlp16, os1-64")->capture_default_str();
  command.add_option("--day", a.drive.day, "other days, other parked cars and traffic")->capture_default_str();
  command.add_option("--route", a.drive.route, "tour, explore, twins, open")->capture_default_str();
  add_choice<Lane>(command, "--lane", a.drive.lane, "lane driven on",
                   {{"right", Lane::kRight}, {"centre", Lane::kCentre}, {"left", Lane::kLeft}});
  add_choice<bool>(command, "--direction", a.drive.reverse, "reverse: the route from its end",
                   {{"forward", false}, {"reverse", true}});
  command.add_option("--rate", a.drive.rate_hz, "sweeps a second; 0: the sensor's own")->capture_default_str();
  command.add_option("--seed", a.drive.seed, "seed of noise, speeds, halts and traffic")->capture_default_str();
  add_choice<LogFormat>(command, "--format", a.write.format, "kitti: .bin; pcd: with ring and time of each point",
                        {{"kitti", LogFormat::kKitti}, {"pcd", LogFormat::kPcd}});
  command.add_flag("--compensated", a.write.compensated, "write scans in the frame of their stamp (motion-compensated)");
  command.add_flag("--from-standstill", a.drive.from_standstill, "start from a halt; else the log starts while moving");
  command.add_option("--pairs", a.pairs.pairs, "make so many pairs of scans instead of a drive")
      ->each([&a](const std::string&) { a.only_pairs = true; });
  command.add_option("--negatives", a.pairs.negatives, "with --pairs: pairs of different places")->capture_default_str();
  command.add_option("--towns", a.towns, "with --pairs: share them out to so many towns")->capture_default_str();
  command.add_option("--sensor-b", a.pairs.sensor_b, "with --pairs: sensor of the target scans");
  command.add_option("--days", a.pairs.days, "with --pairs: scans are taken on so many days")->capture_default_str();
  command.footer(kExamples);
}

int simulate(const SimulateArguments& a) {
  if (a.only_pairs) {
    SimulatePairsArguments pairs{a.output, a.town, a.towns, a.pairs};
    pairs.pairs.sensor = a.drive.sensor;
    pairs.pairs.seed = a.drive.seed;
    return simulate_pairs(pairs);
  }
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
