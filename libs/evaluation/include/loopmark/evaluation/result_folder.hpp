// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The folder of an experiment on disk: what it was, its records, and the products made of them.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "loopmark/evaluation/summary.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark::evaluation {

/// What makes results comparable: kept as experiment.json.
struct Experiment {
  std::string set_name;      ///< the set's file, for tables
  std::string set_sha256;    ///< of the pairs as evaluated, in the published format
  std::string extra_sha256;  ///< of negatives and perturbations
  std::size_t pairs = 0;
  std::size_t negatives = 0;
  SuccessCriterion criterion;
  std::vector<std::string> algorithms;  ///< names, in the order of the tables
  std::vector<std::string> settings;    ///< of each algorithm: what changes its answers, as text

  bool same_task(const Experiment& other) const;
};

/// Part k of N of the pairs: those whose place in the set leaves the rest k - 1 when divided by N.
struct Shard {
  std::size_t index = 1;  ///< from 1
  std::size_t count = 1;
  bool holds(std::size_t pair) const { return pair % count == index - 1; }
};
/// "2/8"; throws InputError for anything else.
Shard shard_from(const std::string& text);

/// An experiment as read back.
struct StoredResult {
  Experiment experiment;
  EvaluatedSet set;
  std::vector<Outcome> outcomes;  ///< by algorithm (in the order of the experiment), then by pair
};

/// Records outcomes of one shard into a result folder, as they come and from any thread.
class OutcomeWriter {
 public:
  /// Makes the folder, or goes on with it. Throws InputError when it holds another experiment.
  OutcomeWriter(const std::filesystem::path& folder, const Experiment& experiment, const EvaluatedSet& set,
                Shard shard);

  bool done(const std::string& algorithm, std::size_t pair) const;
  /// Appends one outcome: first its times, then what counts.
  void add(const Outcome& outcome);
  /// Outcomes that were there before.
  const std::vector<Outcome>& found() const { return found_; }

 private:
  mutable std::mutex mutex_;
  std::vector<Outcome> found_;
  std::set<std::pair<std::string, std::size_t>> done_;
  std::unique_ptr<storage::RecordWriter> records_;
  std::unique_ptr<storage::RecordWriter> times_;
};

/// Reads a result with all of its shards. Throws InputError when pairs are missing, naming the first ones.
StoredResult read_result(const std::filesystem::path& folder);

/// True when every pair of every algorithm is there.
bool result_is_complete(const std::filesystem::path& folder);

/// Joins results of the same task: shards of one experiment, other algorithms, or both. Writes the products to
/// `target`, the same bytes as one process that did all of it (times aside).
StoredResult merge_results(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& target);

/// Writes results.csv, motions/ and tables/ (the same bytes for the same answers) and what holds times:
/// times.csv, summary.json, tables/times and tables/stages.
void write_products(const std::filesystem::path& folder, const StoredResult& result);

/// Orders outcomes by algorithm (in the order of `names`), then by pair.
void sort_outcomes(std::vector<Outcome>& outcomes, const std::vector<std::string>& names);

}  // namespace loopmark::evaluation
