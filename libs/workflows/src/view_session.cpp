// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/view_session.hpp"

#include <cstdio>
#include <sstream>

#include "loopmark/core/error.hpp"
#include "loopmark/workflows/why_run.hpp"
#include "map_report.hpp"

namespace loopmark::workflows {
namespace {

/// "--veto 120-7" as LoopChanges.
LoopChanges parsed(const std::string& words) {
  std::istringstream stream(words);
  std::string option, pair, more;
  stream >> option >> pair;
  LoopChanges changes;
  std::vector<std::string>* into = option == "--veto"     ? &changes.veto
                                   : option == "--force"  ? &changes.force
                                   : option == "--forget" ? &changes.forget
                                                          : nullptr;
  if (into == nullptr || pair.empty() || stream >> more) {
    throw InputError("'" + words +
                     "' is no change of a loop: one of --veto, --force, --forget, and a pair as in 120-7");
  }
  into->push_back(pair);
  return changes;
}

}  // namespace

ViewSession::ViewSession(const std::filesystem::path& run)
    : run_(workflows::open_run(run)), truth_(workflows::truth_of(run_.folder, run_.scans.size())) {
  solve();
}

void ViewSession::solve() {
  map_ = run_.solve();
  summary_ = workflows::summary_of(run_, map_, truth_);
}

map_page::MapPageInput ViewSession::input() const {
  map_page::MapPageInput input = workflows::internal::map_page_input(
      run_.folder, {run_.scans, run_.loops, map_, run_.decisions, truth_, run_.options.slam.min_loop_p}, summary_,
      workflows::times_of(run_));
  input.edits = {true, unsaved()};
  input.earlier_page = run_.folder / "report.html";
  return input;
}

std::string ViewSession::page() const {
  std::ostringstream out;
  map_page::map_page(input()).write(out);
  return out.str();
}

std::vector<std::string> ViewSession::unsaved() const {
  std::vector<std::string> options;
  for (const Before& change : changes_) {
    options.push_back(change.option);
  }
  return options;
}

std::string ViewSession::told(const std::string& what, const std::vector<Pose>& before) const {
  double largest_m = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double moved_m = (map_.T_map_scan[i].translation() - before[i].translation()).norm();
    at = moved_m > largest_m ? i : at;
    largest_m = std::max(largest_m, moved_m);
  }
  char text[160];
  std::snprintf(text, sizeof text,
                ": poses moved by up to %.3f m (scan %zu); %zu of %zu candidates hold, solved in %.2f s.", largest_m,
                at, summary_.loops, summary_.candidates, map_.solution.seconds);
  return what + text;
}

std::string ViewSession::change(const std::string& words) {
  const LoopChanges changes = parsed(words);
  const Before before{run_.loops, run_.decisions, words};
  const std::vector<Pose> poses = map_.T_map_scan;
  try {
    workflows::apply(changes, run_);
  } catch (...) {
    run_.loops = before.loops;
    run_.decisions = before.decisions;
    throw;
  }
  solve();
  changes_.push_back(before);
  return map_page::map_update(input(), told(words.substr(2), poses));
}

std::string ViewSession::undo() {
  if (changes_.empty()) {
    throw InputError("there is nothing to undo");
  }
  const std::vector<Pose> poses = map_.T_map_scan;
  const Before back = changes_.back();
  changes_.pop_back();
  run_.loops = back.loops;
  run_.decisions = back.decisions;
  solve();
  return map_page::map_update(input(), told("undone " + back.option.substr(2), poses));
}

std::string ViewSession::save() {
  if (changes_.empty()) {
    throw InputError("there is nothing to save");
  }
  std::vector<std::string> words = {"view", run_.folder.name().string()};
  for (const Before& change : changes_) {
    words.push_back(change.option);
  }
  const Rewritten done = workflows::rewrite(run_, map_, "", false, words);
  run_ = workflows::open_run(done.run);
  changes_.clear();
  return map_page::map_update(input(), "Saved. The run as it was: " + done.before.string() +
                                           ". Clouds and occupancy are left out until: loopmark loops " +
                                           done.run.string() + " --maps");
}

std::string ViewSession::why(const std::string& pair) const {
  return workflows::inquiry_text(run_, map_,
                                 workflows::inquire(run_, map_, workflows::pair_named(pair, run_, map_.keyframes)));
}

std::string ViewSession::act(const std::string& action, const std::string& words) {
  if (action == "loops") {
    return change(words);
  }
  if (action == "undo") {
    return undo();
  }
  if (action == "save") {
    return save();
  }
  if (action == "why") {
    return why(words);
  }
  throw InputError("'" + action + "' is nothing that a page can ask for");
}

}  // namespace loopmark::workflows
