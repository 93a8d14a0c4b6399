// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The engine beside Open3D and PCL, from raw scans to a motion, on a set of pairs: recall with Wilson intervals, by
// overlap bin, false answers among negatives, times.
//
//   engine_and_peers SET_FOLDER LOGS OUT [EVERY [LIBRARIES]]
//
// SET_FOLDER: pairs.txt, sessions.txt and, where there are any, negatives.txt, pairs_perturbed.txt with perturb.txt.
// EVERY: only each n-th pair. LIBRARIES: a word with what takes part: "open3d", "pcl", "open3d,pcl" (default). A run
// that was stopped goes on where it was; OUT/natural and OUT/perturbed are result folders of loopmark evaluate.
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/experiment.hpp"
#include "loopmark/evaluation/pair_algorithm.hpp"
#include "loopmark/evaluation/result_tables.hpp"
#include "loopmark/evaluation/set_check.hpp"
#include "loopmark/io/dataset.hpp"
#include "peer_algorithms.hpp"

namespace loopmark::benchmarks {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path set, logs, out;
  std::size_t every = 1;
  std::string libraries = "open3d,pcl";
};

evaluation::AlgorithmList competitors(const std::string& libraries) {
  evaluation::AlgorithmList list;
  list.push_back(evaluation::make_pair_algorithm(registration::engine_registration({}),
                                                 config::dump(registration::EngineOptions())));
  for (const auto& library : {open3d_library(), pcl_library()}) {
    if (library && libraries.find(library->name) != std::string::npos) {
      add_peers(list, *library);
    }
  }
  return list;
}

template <class T>
void keep_every(std::vector<T>& things, std::size_t every) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < things.size(); i += every) {
    kept.push_back(things[i]);
  }
  things = std::move(kept);
}

evaluation::ExperimentTask make_task(const Arguments& a, bool perturbed) {
  evaluation::ExperimentTask task;
  task.set.pairs = pair_sets::read_pair_set(a.set / (perturbed ? "pairs_perturbed.txt" : "pairs.txt"));
  task.set_name = perturbed ? "perturbed pairs" : "natural pairs";
  if (perturbed) {
    task.perturbations = pair_sets::read_perturbations(a.set / "perturb.txt", task.set.pairs);
  } else if (fs::exists(a.set / "negatives.txt")) {
    task.set.negatives = pair_sets::read_negatives(a.set / "negatives.txt");
  }
  keep_every(task.set.pairs, a.every);
  keep_every(task.set.negatives, a.every);
  keep_every(task.perturbations, a.every);
  return task;
}

void print_tables(const evaluation::StoredResult& result) {
  const auto summaries = evaluation::summarise_all(result.outcomes, result.experiment.algorithms, result.set);
  std::vector<text::TextTable> tables = {evaluation::overview_table(result.experiment, summaries),
                                         evaluation::bins_table(summaries, "by_overlap", "Recall by symmetric overlap",
                                                                &evaluation::AlgorithmSummary::by_overlap),
                                         evaluation::times_table(summaries)};
  if (!result.set.negatives.empty()) {
    tables.insert(tables.begin() + 2, evaluation::certainty_table(summaries));
  }
  for (const text::TextTable& table : tables) {
    std::printf("%s\n", text::to_markdown(table).c_str());
  }
  std::fflush(stdout);
}

void run_set(const Arguments& a, bool perturbed) {
  const std::shared_ptr<io::Dataset> data = io::open_dataset(a.logs, a.set / "sessions.txt");
  const evaluation::ScanLoader load = [data](int session, int frame) { return data->load(session, frame); };
  evaluation::ExperimentTask task = make_task(a, perturbed);
  evaluation::match_set_to_scans(task, load);
  const fs::path folder = a.out / (perturbed ? "perturbed" : "natural");
  evaluation::run_experiment(task, competitors(a.libraries), load, folder);
  const evaluation::StoredResult result = evaluation::read_result(folder);
  evaluation::write_products(folder, result);
  print_tables(result);
}

int run(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: engine_and_peers SET_FOLDER LOGS OUT [EVERY [LIBRARIES]]\n");
    return 2;
  }
  Arguments a{argv[1], argv[2], argv[3]};
  a.every = static_cast<std::size_t>(argc > 4 ? std::max(1, std::atoi(argv[4])) : 1);
  a.libraries = argc > 5 ? argv[5] : a.libraries;
  run_set(a, false);
  if (fs::exists(a.set / "perturb.txt")) {
    run_set(a, true);
  }
  return 0;
}

}  // namespace
}  // namespace loopmark::benchmarks

int main(int argc, char** argv) {
  try {
    return loopmark::benchmarks::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
