// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/result_folder.hpp"
#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/workflows/run_check.hpp"

namespace loopmark::app {
namespace fs = std::filesystem;
namespace {

struct CheckArguments {
  fs::path what;
  bool repair = false;
  bool structure_only = false;
};

constexpr const char* kExamples = R"(Examples:
  loopmark check runs/day1                structure of all records, and every file against its SHA-256 in manifest.json
  loopmark check runs/day1 --structure    the records alone, without reading the large files
  loopmark check runs/day1 --repair       makes again what can be made from the rest, to the same bytes
  loopmark check RESULT                   the records of an evaluation; with --repair its tables are made again
Exit code 0: all is there. 2: something is wrong; each file is named, with what can be done.)";

const char* remedy_of(const std::string& file) {
  switch (workflows::made_from(file)) {
    case workflows::MadeFrom::kCloud:
      return "can be made again: --repair";
    case workflows::MadeFrom::kRecords:
      return "can be made again, if the records and clouds are sound: --repair";
    default:
      return "cannot be made again from the rest: copy it, or map the log again";
  }
}

int check_one_run(const CheckArguments& a) {
  const map_store::RunFolder run = map_store::RunFolder::open(a.what);
  workflows::RunCheck found = workflows::check_run(run, !a.structure_only);
  if (a.repair && !found.faults.empty()) {
    for (const std::string& file : workflows::repair_run(run, found.faults)) {
      std::printf("%s: made again\n", file.c_str());
    }
    found = workflows::check_run(run, true);
  }
  for (const workflows::RunFault& fault : found.faults) {
    std::printf("%s: %s (%s)\n", fault.file.c_str(), fault.problem.c_str(), remedy_of(fault.file));
  }
  if (!found.faults.empty()) {
    throw InputError(run.path().string(), "", std::to_string(found.faults.size()) + " faults");
  }
  std::printf("%s: sound (%zu files, %.1f MB%s)\n", run.path().c_str(), found.files,
              static_cast<double>(found.bytes) * 1e-6, a.structure_only ? "; sums not taken" : "");
  return 0;
}

int check_result(const CheckArguments& a) {
  const evaluation::StoredResult result = evaluation::read_result(a.what);
  if (a.repair) {
    evaluation::write_products(a.what, result);
  }
  std::printf("%s: sound (%zu outcomes of %zu pairs%s)\n", a.what.c_str(), result.outcomes.size(), result.set.size(),
              a.repair ? "; tables made again" : "");
  return 0;
}

}  // namespace

Action set_up_check(CLI::App& command, const Globals& /*globals*/) {
  const auto arguments = std::make_shared<CheckArguments>();
  command.add_option("WHAT", arguments->what, "a run folder, or a result folder of loopmark evaluate")->required();
  command.add_flag("--repair", arguments->repair, "make again what can be made from the rest");
  command.add_flag("--structure", arguments->structure_only, "do not read the files for their sums");
  command.footer(kExamples);
  return [arguments] {
    return fs::exists(arguments->what / "experiment.json") ? check_result(*arguments) : check_one_run(*arguments);
  };
}

}  // namespace loopmark::app
