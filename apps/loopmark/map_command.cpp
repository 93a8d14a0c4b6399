// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/workflows/map_job.hpp"

namespace loopmark::app {
namespace {

struct MapArguments {
  std::filesystem::path log;
  std::filesystem::path output;
  std::filesystem::path resume;
  std::filesystem::path truth;
};

constexpr const char* kExamples = R"(Examples:
  loopmark map drives/day1 -o runs/day1                        a folder of scans (KITTI, PCD, PLY) or an MRPT rawlog
  loopmark map my.bag -o runs/yard                             ROS 1 and ROS 2 bags, MCAP, packet captures
  loopmark map drive.rawlog -o runs/yard --set log.rate_hz=20  options as in: loopmark config dump
  loopmark map drives/day1 -o runs/day1 --truth truth.tum      errors against a known trajectory
  loopmark map --resume runs/day1                              go on with a run that was interrupted
The run folder holds trajectory.tum, map.bt (OctoMap), cloud.ply, loops.csv, report.html and more; it is called
RUN.partial until it is whole. Nothing is ever overwritten.)";

void declare(CLI::App& command, MapArguments& a) {
  command.add_option("LOG", a.log, "drive log of any format (they are listed by: loopmark doctor --help)");
  command.add_option("-o,--output", a.output, "folder of the run; must not exist");
  command.add_option("--resume", a.resume, "go on with this interrupted run")->excludes("-o");
  command.add_option("--truth", a.truth, "true trajectory: TUM, joined by time, or KITTI, one pose a scan");
  command.footer(kExamples);
}

workflows::MapOutcome start(const MapArguments& a, const Globals& globals) {
  if (a.log.empty() || a.output.empty()) {
    throw InputError("loopmark map needs LOG and -o RUN, or --resume RUN (see: loopmark map --help)");
  }
  return workflows::start_map(a.log, a.truth, a.output, globals.arguments, globals.options());
}

int map(const MapArguments& a, const Globals& globals) {
  const workflows::MapOutcome outcome =
      a.resume.empty() ? start(a, globals) : workflows::resume_map(a.resume, globals.arguments);
  const std::filesystem::path run = a.resume.empty() ? a.output : a.resume;
  std::printf("%s is whole:\n%s", run.c_str(), workflows::closing_table(outcome).c_str());
  std::printf("  map           %s\n  trajectory    %s\n  report        %s\n", (run / "map.bt").c_str(),
              (run / "trajectory.tum").c_str(), (run / "report.html").c_str());
  return 0;
}

}  // namespace

Action set_up_map(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<MapArguments>();
  declare(command, *arguments);
  return interruptible(
      [arguments, &globals] { return map(*arguments, globals); },
      [arguments] { return kept_of_run(arguments->resume.empty() ? arguments->output : arguments->resume); });
}

}  // namespace loopmark::app
