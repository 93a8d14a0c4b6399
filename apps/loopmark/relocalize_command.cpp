// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/localization/relocalization_report.hpp"
#include "loopmark/workflows/relocalize_log.hpp"
#include "loopmark/workflows/relocalize_page.hpp"

namespace loopmark::app {
namespace {

struct RelocalizeArguments {
  workflows::RelocalizeJob job;
  std::filesystem::path output;
};

constexpr const char* kExamples = R"(Examples:
  loopmark relocalize runs/day1 drives/day2 -o where            every scan of day2, tracked once found
  loopmark relocalize runs/day1 drives/day2 -o where --single   each scan on its own, as after a crash
  loopmark relocalize runs/day1 drives/day2 -o where --every 10 --map-truth drives/day1/poses.txt
The output folder holds relocalization.csv (state, P(correct), pose and covariance of each scan), trajectory.tum (the
scans that were placed), report.html (the answers on the map) and summary.json (time to the first pose, losses,
recoveries). With the true poses of the run's scans, and of the log's in the same world, answers are judged.)";

void declare(CLI::App& command, RelocalizeArguments& a) {
  command.add_option("RUN", a.job.run, "map: a run folder of loopmark map")->required();
  command.add_option("LOG", a.job.log, "drive log to place in it")->required();
  command.add_option("-o,--output", a.output, "folder to make; must not exist")->required();
  command.add_option("--every", a.job.every, "take every n-th scan")->check(CLI::PositiveNumber);
  command.add_flag("--single", a.job.single, "place each scan on its own, without the scans before it");
  command.add_option("--map-truth", a.job.map_truth, "true poses of the run's scans (TUM or KITTI)");
  command.add_option("--truth", a.job.truth, "true poses of the log's scans; else those that lie beside it");
  command.footer(kExamples);
}

void print(const localization::RelocalizationSummary& s) {
  std::printf("scans %zu, placed %zu (%.1f %%), first answer ", s.scans, s.answered,
              s.scans > 0 ? 100.0 * static_cast<double>(s.answered) / static_cast<double>(s.scans) : 0.0);
  std::printf(s.first_answer_s < 0.0 ? "none" : "after %.1f s of driving", s.first_answer_s);
  std::printf(", lost %zu times, found again %zu times; %.2f s a scan\n", s.losses, s.recoveries,
              s.scans > 0 ? s.seconds / static_cast<double>(s.scans) : 0.0);
  if (s.judged > 0) {
    std::printf("against the truth: %zu of %zu answers wrong (over 0.6 m or 5 deg), median error %.2f m\n", s.wrong,
                s.judged, s.median_error_m);
  }
}

int relocalize(const RelocalizeArguments& a, const Globals& globals) {
  const std::filesystem::path partial = a.output.string() + ".partial";
  for (const std::filesystem::path& taken : {a.output, partial}) {
    if (std::filesystem::exists(taken)) {
      throw InputError(taken.string(), "", "is there already and is never overwritten", "choose another name for -o");
    }
  }
  const workflows::RelocalizeOutcome outcome = workflows::relocalize_log(a.job, globals.options());
  std::filesystem::create_directories(partial);
  localization::write_relocalization(partial, outcome.scans, outcome.summary);
  workflows::write_relocalization_page(partial, a.job.run, a.job.log.string(), outcome.scans, outcome.summary,
                                       outcome.map_truth ? &*outcome.map_truth : nullptr, outcome.true_query);
  std::filesystem::rename(partial, a.output);
  print(outcome.summary);
  return 0;
}

}  // namespace

Action set_up_relocalize(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<RelocalizeArguments>();
  declare(command, *arguments);
  return interruptible([arguments, &globals] { return relocalize(*arguments, globals); },
                       [] { return "nothing is written; start again with the same command"; });
}

}  // namespace loopmark::app
