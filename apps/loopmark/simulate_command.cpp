// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <functional>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/simulation/drive_writer.hpp"
#include "simulate_pairs.hpp"

namespace loopmark::app {
namespace {

using namespace simulation;

/// What stood on the command line; it goes over the options of --config and --set.
struct SimulateArguments {
  std::filesystem::path output;
  std::size_t towns = 1;
  bool only_pairs = false;
  std::vector<std::function<void(simulation::SimulationOptions&)>> given;
};

constexpr const char* kExamples = R"(Examples:
  loopmark simulate -o drives/day1                                   1 km tour, HDL-64E, raw sweeps
  loopmark simulate -o drives/day2 --day 2 --direction reverse       the same town on another day, driven the other way
  loopmark simulate -o drives/vlp --sensor vlp16 --format pcd        with the time and ring of every point
  loopmark simulate -o drives/mrpt --format rawlog                   for MRPT's tools
  loopmark simulate -o drives/quiet --set simulation.drive.vehicles=0 --set simulation.drive.pedestrians=0
  loopmark simulate -o drives/far --town 7 --route open --length 1500  another town, over the river and back
  loopmark simulate --pairs 500 --towns 5 -o pairs/hdl64e            a balanced set of scan pairs with exact motions
  loopmark simulate --pairs 100 --sensor hdl64e --sensor-b vlp16 -o pairs/cross    one sensor against another
The log (velodyne/, times.txt, poses.txt, calib.txt, sweep.txt, revisits.csv, town.json) can be read by loopmark map.
The truth in poses.txt is the sensor's pose at the stamp of each scan, the moment it looks forward; the time of a point is
relative to that stamp. The same options give the same bytes. More options: loopmark config dump, section simulation.)";

/// An option that changes one member of the options.
template <class Value, class Member>
CLI::Option* add_value(CLI::App& command, SimulateArguments& a, const std::string& name, const std::string& help,
                       const Member& member) {
  return command.add_option_function<Value>(
      name,
      [&a, member](const Value& value) {
        a.given.push_back([member, value](simulation::SimulationOptions& o) { member(o) = value; });
      },
      help);
}

/// An option whose values are words; the help lists the words only.
template <class Enum, class Member>
void add_choice(CLI::App& command, SimulateArguments& a, const std::string& name, const std::string& help,
                const Choices<Enum>& choices, const Member& member) {
  std::vector<std::string> words;
  for (const auto& [word, unused] : choices) {
    words.push_back(word);
  }
  command
      .add_option_function<std::string>(
          name,
          [&a, choices, member](const std::string& given) {
            for (const auto& [word, meaning] : choices) {
              if (given == word) {
                a.given.push_back([member, value = meaning](simulation::SimulationOptions& o) { member(o) = value; });
              }
            }
          },
          help)
      ->check(CLI::IsMember(words))
      ->type_name("");
}

void declare_drive(CLI::App& command, SimulateArguments& a) {
  using O = simulation::SimulationOptions;
  add_value<std::uint64_t>(
      command, a, "--town", "seed of the town (default 1)", [](O & o) -> auto& { return o.town.seed; });
  add_value<double>(
      command, a, "--length", "driven distance, metres (default 1000)",
      [](O & o) -> auto& { return o.drive.length_m; });
  add_value<std::string>(
      command, a, "--sensor", "hdl64e (default), hdl32e, vlp16, os1-64", [](O & o) -> auto& { return o.drive.sensor; })
      ->each([&a](const std::string& name) { a.given.push_back([name](O& o) { o.pairs.sensor = name; }); });
  add_value<int>(
      command, a, "--day", "other days, other parked cars and traffic (default 1)",
      [](O & o) -> auto& { return o.drive.day; });
  add_value<std::string>(
      command, a, "--route", "tour (default), explore, twins, open", [](O & o) -> auto& { return o.drive.route; });
  add_choice<simulation::Lane>(
      command, a, "--lane", "lane driven on (default right)",
      {{"right", simulation::Lane::kRight}, {"centre", simulation::Lane::kCentre}, {"left", simulation::Lane::kLeft}},
      [](O & o) -> auto& { return o.drive.lane; });
  add_choice<bool>(
      command, a, "--direction", "reverse: the route from its end", {{"forward", false}, {"reverse", true}},
      [](O & o) -> auto& { return o.drive.reverse; });
  add_value<double>(
      command, a, "--rate", "sweeps a second, 5 to 20 (default: the sensor's own)",
      [](O & o) -> auto& { return o.drive.rate_hz; });
  add_value<std::uint64_t>(
      command, a, "--seed", "seed of noise, speeds, halts, traffic, pairs (default 1)",
      [](O & o) -> auto& { return o.drive.seed; })
      ->each([&a](const std::string& seed) { a.given.push_back([seed](O& o) { o.pairs.seed = std::stoull(seed); }); });
  add_choice<simulation::LogFormat>(
      command, a, "--format", "kitti (default): .bin; pcd: with ring and time of each point; rawlog: MRPT's",
      {{"kitti", simulation::LogFormat::kKitti},
       {"pcd", simulation::LogFormat::kPcd},
       {"rawlog", simulation::LogFormat::kRawlog}},
      [](O & o) -> auto& { return o.write.format; });
  command.add_flag_callback(
      "--compensated", [&a] { a.given.push_back([](O& o) { o.write.compensated = true; }); },
      "write scans in the frame of their stamp (motion-compensated)");
  command.add_flag_callback(
      "--from-standstill", [&a] { a.given.push_back([](O& o) { o.drive.from_standstill = true; }); },
      "start from a halt; else the log starts while moving");
}

void declare_pairs(CLI::App& command, SimulateArguments& a) {
  using O = simulation::SimulationOptions;
  add_value<std::size_t>(
      command, a, "--pairs", "make so many pairs of scans instead of a drive",
      [](O & o) -> auto& { return o.pairs.pairs; })
      ->each([&a](const std::string&) { a.only_pairs = true; });
  add_value<std::size_t>(
      command, a, "--negatives", "with --pairs: pairs of different places (default 50)",
      [](O & o) -> auto& { return o.pairs.negatives; });
  command.add_option("--towns", a.towns, "with --pairs: share them out to so many towns")->capture_default_str();
  add_value<std::string>(
      command, a, "--sensor-b", "with --pairs: sensor of the target scans",
      [](O & o) -> auto& { return o.pairs.sensor_b; });
  add_value<int>(
      command, a, "--days", "with --pairs: scans are taken on so many days (default 2)",
      [](O & o) -> auto& { return o.pairs.days; });
}

int simulate_drive(const simulation::SimulationOptions& o, const std::filesystem::path& output) {
  check(o.drive);
  const simulation::Town town = simulation::make_town(o.town);
  const simulation::Drive drive(town, o.drive);
  const simulation::World world(town, o.drive.day);
  const Stopwatch watch;
  const simulation::WrittenLog log = simulation::write_drive(world, town, drive, output, o.write);
  const double seconds = watch.seconds();
  const double rays = static_cast<double>(drive.sensor().rays_per_sweep() * log.scans);
  std::printf("%s: %zu scans (%s), %.0f m, %zu revisits, %.1f million points\n", output.c_str(), log.scans,
              drive.sensor().label.c_str(), log.length_m, drive.revisits().size(),
              1e-6 * static_cast<double>(log.points));
  std::printf("%.1f s: %.1f scans/s, %.2f million rays/s\n", seconds, static_cast<double>(log.scans) / seconds,
              1e-6 * rays / seconds);
  return 0;
}

int simulate(const SimulateArguments& a, simulation::SimulationOptions options) {
  for (const auto& change : a.given) {
    change(options);
  }
  if (!a.only_pairs) {
    return simulate_drive(options, a.output);
  }
  return simulate_pairs({a.output, options.town, a.towns, options.pairs});
}

}  // namespace

Action set_up_simulate(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<SimulateArguments>();
  command.add_option("-o,--output", arguments->output, "folder to make; must not exist")->required();
  declare_drive(command, *arguments);
  declare_pairs(command, *arguments);
  command.footer(kExamples);
  return interruptible([arguments, &globals] { return simulate(*arguments, globals.options().simulation); },
                       [arguments] {
                         return arguments->output.string() +
                                ".partial is not whole; the same command starts again and replaces it";
                       });
}

}  // namespace loopmark::app
