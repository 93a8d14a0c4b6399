// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/opened_run.hpp"

#include <algorithm>
#include <charconv>

#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows {
namespace {

std::size_t whole_number(const std::string& digits, const std::string& word) {
  std::size_t number = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number);
  if (digits.empty() || error != std::errc() || stop != end) {
    throw InputError("'" + word + "' names no scan: give its number in the log (120), or that of a keyframe (k12)");
  }
  return number;
}

}  // namespace

OpenedRun open_run(const std::filesystem::path& run, const std::vector<std::string>& settings) {
  const map_store::RunFolder folder = map_store::RunFolder::open(run);
  map_store::RunRecords records = map_store::read_run_records(folder);
  OpenedRun opened{folder, config::load<ProgramOptions>(folder / "config.yaml", settings), std::move(records.scans),
                   std::move(records.loops), std::move(records.decisions)};
  if (mapping::keyframes_of(opened.scans).empty()) {
    throw InputError(folder.scan_records().string(), "", "the run holds no keyframe");
  }
  return opened;
}

std::vector<Pose> truth_of(const map_store::RunFolder& run, std::size_t scans) {
  if (!std::filesystem::exists(truth_file(run))) {
    return {};
  }
  std::vector<Pose> truth = io::read_trajectory(truth_file(run)).poses;
  if (truth.size() != scans) {
    throw InputError(truth_file(run).string(), "",
                     std::to_string(truth.size()) + " poses for " + std::to_string(scans) + " scans");
  }
  return truth;
}

std::size_t keyframe_named(const std::string& word, const OpenedRun& run,
                           const std::vector<mapping::Keyframe>& keyframes, bool nearest) {
  const bool by_number = !word.empty() && word.front() == 'k';
  const std::size_t number = whole_number(by_number ? word.substr(1) : word, word);
  if (number >= (by_number ? keyframes.size() : run.scans.size())) {
    throw InputError(run.folder.name().string(), word,
                     "there is no such " + std::string(by_number ? "keyframe" : "scan"),
                     "the run has scans 0 to " + std::to_string(run.scans.size() - 1) + " and keyframes k0 to k" +
                         std::to_string(keyframes.size() - 1));
  }
  if (by_number) {
    return number;
  }
  std::size_t before = 0;
  while (before + 1 < keyframes.size() && keyframes[before + 1].scan <= number) {
    ++before;
  }
  if (keyframes[before].scan != number && !nearest) {
    throw InputError(run.folder.name().string(), "scan " + word, "is no keyframe",
                     "the keyframe before it is scan " + std::to_string(keyframes[before].scan));
  }
  return before;
}

KeyframePair pair_named(const std::string& text, const OpenedRun& run,
                        const std::vector<mapping::Keyframe>& keyframes) {
  const std::size_t dash = text.find('-');
  if (dash == std::string::npos) {
    throw InputError("'" + text + "' is no pair of scans: write I-J, as in 120-7 or k12-k0");
  }
  const std::size_t i = keyframe_named(text.substr(0, dash), run, keyframes, false);
  const std::size_t j = keyframe_named(text.substr(dash + 1), run, keyframes, false);
  if (i == j) {
    throw InputError("'" + text + "': a loop joins two keyframes, this is one");
  }
  return {std::max(i, j), std::min(i, j)};
}

std::size_t loop_of(const OpenedRun& run, const KeyframePair& pair) {
  const auto found = std::find_if(run.loops.begin(), run.loops.end(), [&](const map_store::LoopRecord& loop) {
    return loop.source == pair.source && loop.target == pair.target;
  });
  return static_cast<std::size_t>(found - run.loops.begin());
}

}  // namespace loopmark::workflows
