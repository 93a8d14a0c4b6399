// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A run that a person looks at and changes: each change is solved at once, kept in memory, and saved when asked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/map_page/map_page.hpp"
#include "loopmark/workflows/loops_run.hpp"

namespace loopmark::workflows {

class ViewSession {
 public:
  /// Throws InputError as open_run does.
  explicit ViewSession(const std::filesystem::path& run);

  std::string page() const;

  /// "loops" with "--veto 120-7" (or --force, --forget), "undo", "save": the map as it is then, for the open page.
  /// "why" with "120-7": what registration says of the two scans. Throws InputError when the request makes no sense;
  /// then nothing has changed.
  std::string act(const std::string& action, const std::string& words);

  /// Options of `loopmark loops` that make the changes that are not saved; empty when there are none.
  std::vector<std::string> unsaved() const;

 private:
  /// What a change replaced.
  struct Before {
    std::vector<map_store::LoopRecord> loops;
    std::vector<map_store::LoopDecision> decisions;
    std::string option;
  };

  std::string change(const std::string& words);
  std::string undo();
  std::string save();
  std::string why(const std::string& pair) const;
  void solve();
  std::string told(const std::string& what, const std::vector<Pose>& before) const;
  map_page::MapPageInput input() const;

  OpenedRun run_;
  mapping::SolvedMap map_;
  std::vector<Pose> truth_;
  MapSummary summary_;
  std::vector<Before> changes_;
};

}  // namespace loopmark::workflows
