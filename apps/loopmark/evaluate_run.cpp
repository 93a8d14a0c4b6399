// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_run.hpp"

#include <algorithm>
#include <cstdio>

#include "evaluate_algorithms.hpp"
#include "evaluate_report.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/evaluation/experiment.hpp"
#include "loopmark/evaluation/set_check.hpp"
#include "loopmark/io/dataset.hpp"

namespace loopmark::app {
namespace {

evaluation::ExperimentTask make_task(const EvaluateArguments& arguments) {
  evaluation::ExperimentTask task;
  task.set.pairs = pair_sets::read_pair_set(arguments.set);
  if (!arguments.negatives.empty()) {
    task.set.negatives = pair_sets::read_negatives(arguments.negatives);
  }
  if (!arguments.perturb.empty()) {
    task.perturbations = pair_sets::read_perturbations(arguments.perturb, task.set.pairs);
  }
  task.set_name = arguments.set.filename().string();
  task.criterion = arguments.criterion;
  task.shard = evaluation::shard_from(arguments.shard);
  task.pairs_at_once = arguments.pairs_at_once == 0 ? thread_count() : arguments.pairs_at_once;
  return task;
}

std::unique_ptr<io::Dataset> open_data(const EvaluateArguments& arguments) {
  std::filesystem::path sessions = arguments.sessions;
  const std::filesystem::path beside = arguments.set.parent_path() / "sessions.txt";
  if (sessions.empty() && std::filesystem::exists(beside)) {
    sessions = beside;
  }
  return io::open_dataset(arguments.data, sessions);
}

/// Every scan that the shard needs is there; a missing one is told before the work starts.
void check_frames(const evaluation::ExperimentTask& task, const io::Dataset& data) {
  for (std::size_t index = 0; index < task.set.size(); ++index) {
    if (task.shard.holds(index)) {
      const pair_sets::PairKey& key = task.set.key(index);
      data.frame_index(key.session, key.source);
      data.frame_index(key.target_session, key.target);
    }
  }
}

/// The scans of the task, once they are known to be the right ones; empty when nothing needs scans and no
/// data is given.
evaluation::ScanLoader make_loader(const EvaluateArguments& arguments, const evaluation::AlgorithmList& algorithms,
                                   evaluation::ExperimentTask& task) {
  const bool needed = std::any_of(algorithms.begin(), algorithms.end(), [](const auto& a) { return a->needs_scans(); });
  if (!needed && arguments.data.empty()) {
    return {};
  }
  if (arguments.data.empty()) {
    throw InputError("--data ROOT is needed: " + algorithms.back()->name() + " works on scans");
  }
  const std::shared_ptr<io::Dataset> data = open_data(arguments);
  check_frames(task, *data);
  const evaluation::ScanLoader load = [data](int session, int frame) { return data->load(session, frame); };
  if (!arguments.no_check && evaluation::match_set_to_scans(task, load)) {
    std::printf("the motions of %s are of the scans before --perturb: now they include it\n", task.set_name.c_str());
  }
  return load;
}

}  // namespace

int run_evaluate(const EvaluateArguments& given, const Globals& globals) {
  EvaluateArguments arguments = given;
  if (std::filesystem::is_directory(arguments.set)) {
    arguments.set /= "pairs.txt";
  }
  if (arguments.set.empty() || arguments.output.empty()) {
    throw InputError("loopmark evaluate SET -o RESULT: the pairs file and the result folder are needed (see --help)");
  }
  evaluation::ExperimentTask task = make_task(arguments);
  const evaluation::AlgorithmList algorithms = make_algorithms(arguments, globals.options(), task.set);
  const evaluation::ScanLoader load = make_loader(arguments, algorithms, task);
  evaluation::run_experiment(task, algorithms, load, arguments.output);
  if (!evaluation::result_is_complete(arguments.output)) {
    std::printf("shard %s is done; loopmark evaluate merge %s makes the tables when all shards are\n",
                arguments.shard.c_str(), arguments.output.c_str());
    return 0;
  }
  const evaluation::StoredResult result = evaluation::read_result(arguments.output);
  evaluation::write_products(arguments.output, result);
  write_evaluation_report(arguments.output, result, load, task.perturbations, arguments.pictures);
  print_overview(result);
  std::printf("written to %s (report.html, summary.json, results.csv, tables/)\n", arguments.output.c_str());
  return 0;
}

}  // namespace loopmark::app
