// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/report/table.hpp"
#include "loopmark/workflows/loops_run.hpp"

namespace loopmark::app {
namespace {

struct LoopsArguments {
  std::filesystem::path run;
  std::filesystem::path output;
  workflows::LoopChanges changes;
  bool maps = false;
  bool csv = false;
};

constexpr const char* kExamples = R"(Examples:
  loopmark loops runs/day1                          every loop candidate with its verdict
  loopmark loops runs/day1 --veto 1530-12           solve again without a loop; the old run stays as runs/day1.before-1
  loopmark loops runs/day1 --force 1530-12 -o new   trust a loop, candidate or not; the result in a new folder
  loopmark loops runs/day1 --forget 1530-12         take a decision back
  loopmark loops runs/day1 --set slam.min_loop_p=0.8 -o new --maps
                                                    other options of the graph; clouds and occupancy made anew, too
Pairs are numbers of scans in the log as the list shows them (or of keyframes: k31-k0), in either order. Neither the log
nor odometry is needed again. Decisions stay with the run; clouds and occupancy are left out without --maps.)";

void declare(CLI::App& command, LoopsArguments& a) {
  command.add_option("RUN", a.run, "run folder of loopmark map")->required();
  const auto pairs = [&](const char* option, std::vector<std::string>& into, const char* help) {
    command.add_option(option, into, help)->type_name("I-J")->allow_extra_args(false);
  };
  pairs("--veto", a.changes.veto, "solve without this loop; may be repeated");
  pairs("--force", a.changes.force, "trust this loop whatever its evidence; may be repeated");
  pairs("--forget", a.changes.forget, "take back an earlier veto or force; may be repeated");
  command.add_option("-o,--output", a.output,
                     "new run folder; else the run is replaced and the old one kept beside it");
  command.add_flag("--maps", a.maps, "make cloud, occupancy and MRPT's files anew");
  command.add_flag("--csv", a.csv, "list as CSV");
  command.footer(kExamples);
}

/// Only what the graph and the products depend on can change now; the rest tells how odometry and loops were found.
void check_settings(const Globals& globals) {
  static constexpr std::array kChangeable = {"slam.min_loop_p",  "slam.max_loop_m", "slam.drift_",        "slam.floor_",
                                             "slam.loop_floor_", "pose_graph.",     "slam.cloud_voxel_m", "occupancy."};
  if (!globals.config_file.empty()) {
    throw InputError(globals.config_file.string(), "", "a run keeps its own options", "change single ones with --set");
  }
  for (const std::string& setting : globals.settings) {
    if (std::none_of(kChangeable.begin(), kChangeable.end(), [&](const char* p) { return setting.starts_with(p); })) {
      throw InputError("--set " + setting +
                       ": needs loopmark map again; here pose_graph, occupancy and, of slam, "
                       "min_loop_p, max_loop_m, drift, floors and cloud_voxel_m can change");
    }
  }
}

report::Table loop_table(const workflows::OpenedRun& run, const mapping::SolvedMap& map) {
  report::Table table(
      {"source scan", "target scan", "keyframes", "proposed by", "P(correct)", "verdict", "weight", "chi2"});
  for (std::size_t i = 0; i < run.loops.size(); ++i) {
    const map_store::LoopRecord& loop = run.loops[i];
    const mapping::LoopVerdict& verdict = map.loops[i];
    const std::string word = verdict.accepted ? "accepted" : "rejected";
    table.row({report::count_cell(map.keyframes[loop.source].scan), report::count_cell(map.keyframes[loop.target].scan),
               "k" + std::to_string(loop.source) + "-k" + std::to_string(loop.target), loop.origin,
               report::number_cell(loop.p_correct, 3), verdict.reason.empty() ? word : word + ": " + verdict.reason,
               verdict.edge ? report::number_cell(verdict.weight, 2) : report::Cell("-"),
               verdict.edge ? report::number_cell(verdict.chi2, 1) : report::Cell("-")});
  }
  return table;
}

void list(const workflows::OpenedRun& run, const mapping::SolvedMap& map, bool csv) {
  const report::Table table = loop_table(run, map);
  std::fputs((csv ? table.csv() : table.text()).c_str(), stdout);
  if (csv) {
    return;
  }
  const auto accepted =
      std::count_if(map.loops.begin(), map.loops.end(), [](const mapping::LoopVerdict& loop) { return loop.accepted; });
  std::printf(
      "%zd accepted of %zu candidates, %zu decided by a person; %zu keyframes in %zu component%s, solved in %.2f s\n",
      static_cast<std::ptrdiff_t>(accepted), run.loops.size(), run.decisions.size(), map.keyframes.size(),
      map.components, map.components == 1 ? "" : "s", map.solution.seconds);
}

std::vector<std::string> words_of(const LoopsArguments& a, const Globals& globals) {
  std::vector<std::string> words = {"loops", a.run.string()};
  const auto add = [&](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) {
      words.insert(words.end(), {option, value});
    }
  };
  add("--veto", a.changes.veto);
  add("--force", a.changes.force);
  add("--forget", a.changes.forget);
  add("--set", globals.settings);
  if (a.maps) {
    words.emplace_back("--maps");
  }
  return words;
}

/// How far the poses went, so that a person sees at once what the decision did.
void print_change(const std::vector<Pose>& before, const mapping::SolvedMap& after) {
  double largest_m = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < after.T_map_scan.size(); ++i) {
    const double moved = (after.T_map_scan[i].translation() - before[i].translation()).norm();
    at = moved > largest_m ? i : at;
    largest_m = std::max(largest_m, moved);
  }
  std::printf("poses moved by up to %.3f m (scan %zu)\n", largest_m, at);
}

/// The poses that the run shows now: solving for them again would take as long as the new solution.
std::vector<Pose> poses_of(const workflows::OpenedRun& run) {
  const std::filesystem::path file = run.folder / "trajectory.tum";
  std::vector<Pose> poses = io::read_trajectory(file).poses;
  if (poses.size() != run.scans.size()) {
    throw InputError(file.string(), "",
                     std::to_string(poses.size()) + " poses for " + std::to_string(run.scans.size()) + " scans");
  }
  return poses;
}

int loops(const LoopsArguments& a, const Globals& globals) {
  check_settings(globals);
  const workflows::LoopChanges& c = a.changes;
  workflows::OpenedRun run = workflows::open_run(a.run, globals.settings);
  if (c.veto.empty() && c.force.empty() && c.forget.empty() && a.output.empty() && !a.maps) {
    list(run, run.solve(), a.csv);
    return 0;
  }
  const std::vector<Pose> before = poses_of(run);
  workflows::apply(c, run);
  const mapping::SolvedMap map = run.solve();
  const workflows::Rewritten done = workflows::rewrite(run, map, a.output, a.maps, words_of(a, globals));
  list(run, map, a.csv);
  if (a.csv) {
    return 0;
  }
  print_change(before, map);
  if (done.summary.absolute) {
    std::printf("ATE %.3f m\n", done.summary.absolute->rmse_m);
  }
  std::printf("%s is whole, after %.2f s%s\n", done.run.c_str(), done.seconds,
              a.maps ? "" : "; without clouds and occupancy (--maps makes them)");
  if (!done.before.empty()) {
    std::printf("the run as it was: %s\n", done.before.c_str());
  }
  return 0;
}

}  // namespace

Action set_up_loops(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<LoopsArguments>();
  declare(command, *arguments);
  return interruptible([arguments, &globals] { return loops(*arguments, globals); },
                       [] { return "the run is as it was; start again with the same command"; });
}

}  // namespace loopmark::app
