// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "loopmark/config/options_io.hpp"
#include "loopmark/core/files.hpp"
#include "map_run.hpp"

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
  loopmark map drive.rawlog -o runs/yard --set log.rate_hz=20  options as in: loopmark config dump
  loopmark map drives/day1 -o runs/day1 --truth truth.tum      errors against a known trajectory
  loopmark map --resume runs/day1                              go on with a run that was interrupted
The run folder holds trajectory.tum, map.bt (OctoMap), cloud.ply, loops.csv, report.html and more; it is called
RUN.partial until it is whole. Nothing is ever overwritten.)";

void declare(CLI::App& command, MapArguments& a) {
  command.add_option("LOG", a.log, "drive log: a folder of scans or a rawlog");
  command.add_option("-o,--output", a.output, "folder of the run; must not exist");
  command.add_option("--resume", a.resume, "go on with this interrupted run")->excludes("-o");
  command.add_option("--truth", a.truth, "true trajectory (TUM or KITTI), one pose a scan");
  command.footer(kExamples);
}

std::filesystem::path job_file(const RunFolder& folder) { return folder / "records/job.json"; }

void write_job(const RunFolder& folder, const MapJob& job, const AppOptions& options) {
  const nlohmann::ordered_json json = {
      {"log", job.log.string()}, {"truth", job.truth.string()}, {"arguments", job.arguments}, {"resumed", job.resumed}};
  write_file_atomically(folder / "config.yaml", options_as_yaml(options));
  write_file_atomically(job_file(folder), json.dump(1) + "\n");
}

MapJob read_job(const RunFolder& folder) {
  const nlohmann::json json = nlohmann::json::parse(read_file(job_file(folder)));
  return {json.at("log").get<std::string>(), json.at("truth").get<std::string>(),
          json.value("arguments", std::vector<std::string>{}),
          json.value("resumed", std::vector<std::vector<std::string>>{})};
}

MapOutcome start(const MapArguments& a, const Globals& globals) {
  if (a.log.empty() || a.output.empty()) {
    throw InputError("loopmark map needs LOG and -o RUN, or --resume RUN (see: loopmark map --help)");
  }
  const AppOptions options = globals.options();
  if (!std::filesystem::exists(a.log)) {
    throw InputError(a.log.string(), "", "there is no such log", "give a folder of scans or a rawlog");
  }
  const MapJob job{std::filesystem::absolute(a.log), a.truth.empty() ? a.truth : std::filesystem::absolute(a.truth),
                   globals.arguments};
  const RunFolder folder = RunFolder::create(a.output);
  try {
    write_job(folder, job, options);
    return run_map(folder, job, options);
  } catch (...) {
    if (!std::filesystem::exists(folder.scan_records())) {  // there is nothing yet that could be resumed
      std::error_code ignored;
      std::filesystem::remove_all(folder.path(), ignored);
    }
    throw;
  }
}

MapOutcome go_on(const MapArguments& a, const Globals& globals) {
  const RunFolder folder = RunFolder::resume(a.resume);
  const AppOptions options = config::load<AppOptions>(folder / "config.yaml", {});
  MapJob job = read_job(folder);
  job.resumed.push_back(globals.arguments);
  write_job(folder, job, options);
  return run_map(folder, job, options);
}

int map(const MapArguments& a, const Globals& globals) {
  const MapOutcome outcome = a.resume.empty() ? start(a, globals) : go_on(a, globals);
  const std::filesystem::path run = a.resume.empty() ? a.output : a.resume;
  std::printf("%s is whole:\n%s", run.c_str(), closing_table(outcome).c_str());
  std::printf("  map           %s\n  trajectory    %s\n  report        %s\n", (run / "map.bt").c_str(),
              (run / "trajectory.tum").c_str(), (run / "report.html").c_str());
  return 0;
}

}  // namespace

Action set_up_map(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<MapArguments>();
  declare(command, *arguments);
  return [arguments, &globals] { return map(*arguments, globals); };
}

}  // namespace loopmark::app
