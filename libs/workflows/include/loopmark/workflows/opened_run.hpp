// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What loops and why share: a whole run with all it remembers, and pairs of scans as people name them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/map_store/loop_decisions.hpp"
#include "loopmark/map_store/records.hpp"
#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/workflows/options.hpp"

namespace loopmark::workflows {

struct OpenedRun {
  map_store::RunFolder folder;
  ProgramOptions options;  ///< the run was made with
  std::vector<map_store::ScanRecord> scans;
  std::vector<map_store::LoopRecord> loops;
  std::vector<map_store::LoopDecision> decisions;

  mapping::SolvedMap solve() const {
    return mapping::solve_map(scans, loops, options.slam, options.pose_graph, decisions);
  }
};

/// Throws InputError when there is no whole run or it holds no keyframe. `settings` change the run's options.
OpenedRun open_run(const std::filesystem::path& run, const std::vector<std::string>& settings = {});

/// records/truth.tum of a run: one pose for each of its scans, or none. Throws InputError when there are others.
std::vector<Pose> truth_of(const map_store::RunFolder& run, std::size_t scans);

/// Two keyframes, the later one first.
struct KeyframePair {
  std::size_t source = 0;
  std::size_t target = 0;
};

/// The keyframe that a word names: "120" is a scan of the log that is a keyframe, "k12" a keyframe by its number.
/// `nearest`: a scan that is none stands for the keyframe before it (or the first one). Throws InputError otherwise.
std::size_t keyframe_named(const std::string& word, const OpenedRun& run,
                           const std::vector<mapping::Keyframe>& keyframes, bool nearest);

/// "I-J" in either order. Throws InputError when it is no pair or both are the same keyframe.
KeyframePair pair_named(const std::string& text, const OpenedRun& run, const std::vector<mapping::Keyframe>& keyframes);

/// The record of a pair, or run.loops.size().
std::size_t loop_of(const OpenedRun& run, const KeyframePair& pair);

}  // namespace loopmark::workflows
