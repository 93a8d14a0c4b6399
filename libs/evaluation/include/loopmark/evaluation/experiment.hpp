// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Runs algorithms over the pairs of a set.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "loopmark/evaluation/algorithm.hpp"
#include "loopmark/evaluation/result_folder.hpp"

namespace loopmark::evaluation {

/// Loads the scan of a session and frame. Thread-safe; throws InputError when there is none.
using ScanLoader = std::function<PointCloud(int session, int frame)>;

/// What is to be run.
struct ExperimentTask {
  EvaluatedSet set;
  std::vector<Pose> perturbations;  ///< of the source points, one a pair, or none; set.pairs includes them already
  std::string set_name;
  SuccessCriterion criterion;
  Shard shard;
  std::size_t pairs_at_once = 1;  ///< pairs worked on at the same time
};

/// The identity of the task, for experiment.json.
Experiment describe_experiment(const ExperimentTask& task, const AlgorithmList& algorithms);

/// Runs what is missing of the task's shard and records it in `folder`. `load` may be empty when no algorithm
/// needs scans. Throws Interrupted when the user stops it: what is done is kept.
void run_experiment(const ExperimentTask& task, const AlgorithmList& algorithms, const ScanLoader& load,
                    const std::filesystem::path& folder);

}  // namespace loopmark::evaluation
