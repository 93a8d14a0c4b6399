// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/workflows/why_run.hpp"

namespace loopmark::app {
namespace {

struct WhyArguments {
  std::filesystem::path run;
  std::string first;
  std::string second;
  std::filesystem::path picture;
};

constexpr const char* kExamples = R"(Examples:
  loopmark why runs/day1 1530 12                       why is, or is not, there a loop between these scans?
  loopmark why runs/day1 k31 k0 --picture loop.png     the same by keyframes, with a picture before and after
Scans are numbers in the log; one that is no keyframe stands for the keyframe before it. The registration is made again
from what the run keeps of the keyframes, so that all its answers can be shown, also for a pair never tried before.)";

int why(const WhyArguments& a, const Globals& globals) {
  if (!globals.config_file.empty() || !globals.settings.empty()) {
    throw InputError("loopmark why shows a run with its own options: leave --config and --set out");
  }
  const workflows::OpenedRun run = workflows::open_run(a.run);
  const mapping::SolvedMap map = run.solve();
  const std::size_t i = workflows::keyframe_named(a.first, run, map.keyframes, true);
  const std::size_t j = workflows::keyframe_named(a.second, run, map.keyframes, true);
  if (i == j) {
    throw InputError(a.run.string(), a.first + " and " + a.second, "stand for the same keyframe, k" + std::to_string(i),
                     "name scans further apart");
  }
  const workflows::Verifier inquiry = workflows::inquire(run, map, {std::max(i, j), std::min(i, j)});
  std::fputs(workflows::inquiry_text(run, map, inquiry).c_str(), stdout);
  if (!a.picture.empty()) {
    workflows::write_inquiry_picture(run, inquiry, a.picture);
    std::printf("picture       %s\n", a.picture.c_str());
  }
  return 0;
}

}  // namespace

Action set_up_why(CLI::App& command, const Globals& globals) {
  auto a = std::make_shared<WhyArguments>();
  command.add_option("RUN", a->run, "run folder of loopmark map")->required();
  command.add_option("I", a->first, "scan of the log, or keyframe (k12)")->required();
  command.add_option("J", a->second, "scan of the log, or keyframe (k0)")->required();
  command.add_option("--picture", a->picture, "writes a PNG: before and after, from above and from the side");
  command.footer(kExamples);
  return [a, &globals] { return why(*a, globals); };
}

}  // namespace loopmark::app
