// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/drill_run.hpp"
#include "loopmark/workflows/map_job.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;

struct DrillArguments {
  fs::path what;
  fs::path output;
  workflows::DrillJob job;
  std::optional<std::size_t> events;
  std::optional<std::uint64_t> seed;
  std::optional<double> within_s;
  std::optional<double> limit_s;
};

constexpr const char* kExamples = R"(Examples:
  loopmark drill runs/day1 -o drill                        cuts tracking in the map of a run 40 times and tells what came of it
  loopmark drill drives/day1 -o drill                      a log: maps it first (into drill/map)
  loopmark drill runs/day1 -o drill --events 200 --seed 7  the same seed gives the same bytes
  loopmark drill runs/day1 -o again --only 17,42           of the 40 those that drill.csv numbers 17 and 42
  loopmark drill runs/day1 -o drill --drive drives/day2    also goes on in another drive of the same place
  loopmark drill runs/day1 -o drill --set drill.outages_s=[0.5,5,60] --set relocalization.tracking_p=0.95
  loopmark drill runs/day1 -o drill --log /elsewhere/day1  when the run's log has moved
Cuts are spread over straights, junctions, open stretches and places that look alike (found from the map itself), over
outages of 0.5 to 60 s, teleports to another part of the log, turns of the sensor, and the other drive. Poses are judged
by the run's own trajectory; another drive needs true poses (poses.txt beside it, or --truth) in the world of the map's
(those that the run was mapped with, or --map-truth). OUT holds report.html, drill.csv (a row an event) and
summary.json.)";

void declare(CLI::App& command, DrillArguments& a) {
  command.add_option("WHAT", a.what, "a run of loopmark map, or a drive log")->required();
  command.add_option("-o,--output", a.output, "folder to make; must not exist")->required();
  command.add_option("--events", a.events, "number of cuts (default 40)")->check(CLI::PositiveNumber);
  command.add_option("--only", a.job.only, "of these cuts, run those alone that drill.csv numbers so: 17,42")
      ->delimiter(',');
  command.add_option("--seed", a.seed, "seed of everything drawn (default 1)");
  command.add_option("--within", a.within_s, "found again in time: seconds of driving (default 5)");
  command.add_option("--limit", a.limit_s, "give an event up after so many seconds of driving (default 15)");
  command.add_option("--log", a.job.log, "the run's log, if it is no longer where it was mapped");
  command.add_option("--drive", a.job.drive, "another drive of the same place");
  command.add_option("--truth", a.job.drive_truth, "true poses of that drive's scans (TUM or KITTI)")->needs("--drive");
  command.add_option("--map-truth", a.job.map_truth, "true poses of the run's scans, in the same world");
  command.footer(kExamples);
}

bool is_run(const fs::path& path) { return fs::exists(path / "records" / "scans.rec"); }

/// Maps the log into OUT.partial/map.
fs::path map_of(const DrillArguments& a, const fs::path& partial, const Globals& globals,
                const workflows::ProgramOptions& options) {
  fs::create_directories(partial);
  workflows::start_map(a.what, a.job.map_truth, partial / "map", globals.arguments, options);
  return partial / "map";
}

workflows::ProgramOptions options_of(const DrillArguments& a, const Globals& globals) {
  workflows::ProgramOptions options = globals.options();
  options.drill.events = a.events.value_or(options.drill.events);
  options.drill.seed = a.seed.value_or(options.drill.seed);
  options.drill.within_s = a.within_s.value_or(options.drill.within_s);
  options.drill.limit_s = a.limit_s.value_or(options.drill.limit_s);
  check(options.drill);
  check(options.relocalization);
  return options;
}

void must_not_exist(const fs::path& path, const std::string& remedy) {
  if (fs::exists(path)) {
    throw InputError(path.string(), "", "is there already and is never overwritten", remedy);
  }
}

int drill(const DrillArguments& a, const Globals& globals) {
  const workflows::ProgramOptions options = options_of(a, globals);
  const fs::path partial = a.output.string() + ".partial";
  must_not_exist(a.output, "choose another name for -o");
  must_not_exist(partial, "a drill was interrupted here: remove it, or choose another name for -o");
  for (const fs::path& input : {a.what, a.job.log, a.job.drive, a.job.drive_truth, a.job.map_truth}) {
    if (!input.empty() && !fs::exists(input)) {
      throw InputError(input.string(), "", "is not there");
    }
  }
  workflows::DrillJob job = a.job;
  job.run = is_run(a.what) ? a.what : map_of(a, partial, globals, options);
  const workflows::DrillResult result = workflows::run_drill(job, a.what.string(), options);
  fs::create_directories(partial);
  workflows::write_drill(partial, job.run, result);
  storage::write_file_atomically(partial / "config.yaml", workflows::options_as_yaml(options));
  fs::rename(partial, a.output);
  std::printf("%s%zu events (of %zu asked for); report %s\n", workflows::drill_table(result).c_str(),
              result.events.size(), options.drill.events, (a.output / "report.html").c_str());
  return 0;
}

std::string kept_of_drill(const DrillArguments& a) {
  const fs::path partial = a.output.string() + ".partial";
  if (!fs::exists(partial)) {
    return "nothing is written; start again with the same command";
  }
  const fs::path map = partial / "map";
  return fs::exists(map) ? "the map is whole; go on with: loopmark drill " + map.string() + " -o NEW_FOLDER"
                         : kept_of_run(map) + ", then: loopmark drill " + map.string() + " -o NEW_FOLDER";
}

}  // namespace

Action set_up_drill(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<DrillArguments>();
  declare(command, *arguments);
  return interruptible([arguments, &globals] { return drill(*arguments, globals); },
                       [arguments] { return kept_of_drill(*arguments); });
}

}  // namespace loopmark::app
