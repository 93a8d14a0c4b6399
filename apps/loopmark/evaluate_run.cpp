// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_run.hpp"

#include <cstdio>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/evaluation/experiment.hpp"

namespace loopmark::app {
namespace {

/// "NAME=FILE", or FILE whose name is taken.
std::pair<std::string, std::filesystem::path> named_file(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0) {
    return {text.substr(0, equals), text.substr(equals + 1)};
  }
  return {std::filesystem::path(text).stem().string(), text};
}

AlgorithmList make_algorithms(const EvaluateArguments& arguments, const EvaluatedSet& set) {
  AlgorithmList algorithms;
  for (const std::string& text : arguments.motions) {
    const auto [name, file] = named_file(text);
    algorithms.push_back(make_motions_algorithm(name, motions_of_pairs(set.pairs, read_motions(file), file)));
  }
  if (algorithms.empty()) {
    throw InputError("nothing to evaluate: give --motions FILE");
  }
  return algorithms;
}

ExperimentTask make_task(const EvaluateArguments& arguments) {
  ExperimentTask task;
  task.set.pairs = read_pair_set(arguments.set);
  if (!arguments.negatives.empty()) {
    task.set.negatives = read_negatives(arguments.negatives);
  }
  task.set_name = arguments.set.filename().string();
  task.criterion = arguments.criterion;
  task.shard = shard_from(arguments.shard);
  task.pairs_at_once = arguments.pairs_at_once == 0 ? thread_count() : arguments.pairs_at_once;
  return task;
}

}  // namespace

int run_evaluate(const EvaluateArguments& arguments, const Globals& /*globals*/) {
  if (arguments.set.empty() || arguments.output.empty()) {
    throw InputError("loopmark evaluate SET -o RESULT: the pairs file and the result folder are needed (see --help)");
  }
  const ExperimentTask task = make_task(arguments);
  const AlgorithmList algorithms = make_algorithms(arguments, task.set);
  run_experiment(task, algorithms, {}, arguments.output);
  if (!result_is_complete(arguments.output)) {
    std::printf("shard %s is done; loopmark evaluate merge %s makes the tables when all shards are\n",
                arguments.shard.c_str(), arguments.output.c_str());
    return 0;
  }
  const StoredResult result = read_result(arguments.output);
  write_products(arguments.output, result);
  print_overview(result);
  std::printf("written to %s\n", arguments.output.c_str());
  return 0;
}

}  // namespace loopmark::app
