// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "command.hpp"
#include "loopmark/evaluation/result_folder.hpp"

namespace loopmark::app {

/// What stands on the command line of an experiment.
struct EvaluateArguments {
  std::filesystem::path set;
  std::filesystem::path data;
  std::filesystem::path sessions;
  std::filesystem::path output;
  std::vector<std::string> algorithms;
  std::vector<std::string> motions;
  std::vector<std::string> features;
  std::vector<std::string> descriptors;
  std::vector<std::string> commands;
  std::vector<std::string> refine;
  std::size_t repeats = 1;
  std::filesystem::path negatives;
  std::filesystem::path perturb;
  evaluation::SuccessCriterion criterion;
  double time_limit_s = 30.0;
  std::size_t pairs_at_once = 0;
  std::string shard = "1/1";
  bool no_check = false;
  std::size_t pictures = 500;
};

/// Runs the experiment, writes the result folder and prints the overview.
int run_evaluate(const EvaluateArguments& arguments, const Globals& globals);

/// Prints the overview of a result.
void print_overview(const evaluation::StoredResult& result);

}  // namespace loopmark::app
