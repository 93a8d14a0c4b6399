// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/result_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "outcome_json.hpp"

namespace loopmark::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExperimentFile = "experiment.json";
constexpr const char* kPairsFile = "pairs.txt";
constexpr const char* kNegativesFile = "negatives.txt";
using OutcomeKey = std::pair<std::string, std::size_t>;

/// Holds the folder's lock file for a moment.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : file_(::open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ >= 0) {
      ::flock(file_, LOCK_EX);
    }
  }
  ~FolderLock() {
    if (file_ >= 0) {
      ::close(file_);
    }
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_;
};

std::string shard_name(Shard shard) { return std::to_string(shard.index) + "-of-" + std::to_string(shard.count); }

std::vector<fs::path> files_with_ending(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ending) {
        files.push_back(entry.path());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

Experiment read_experiment(const fs::path& folder) {
  if (!fs::exists(folder / kExperimentFile)) {
    throw InputError(folder.string(), "", "no experiment here (experiment.json is missing)",
                     "name the folder that loopmark evaluate -o wrote");
  }
  return internal::experiment_from_json(storage::read_file(folder / kExperimentFile),
                                        (folder / kExperimentFile).string());
}

EvaluatedSet read_set(const fs::path& folder, const Experiment& experiment) {
  EvaluatedSet set{pair_sets::read_pair_set(folder / kPairsFile), {}};
  if (fs::exists(folder / kNegativesFile)) {
    set.negatives = pair_sets::read_negatives(folder / kNegativesFile);
  }
  if (set.pairs.size() != experiment.pairs || set.negatives.size() != experiment.negatives) {
    throw InputError((folder / kPairsFile).string(), "",
                     "holds " + std::to_string(set.pairs.size()) + " pairs and " +
                         std::to_string(set.negatives.size()) + " negatives, but " + kExperimentFile + " tells of " +
                         std::to_string(experiment.pairs) + " and " + std::to_string(experiment.negatives),
                     "copy the folder again");
  }
  return set;
}

/// Writes the experiment unless one is there; shards that start at the same time take turns.
void write_experiment(const fs::path& folder, const Experiment& experiment, const EvaluatedSet& set) {
  const FolderLock lock(folder);
  if (fs::exists(folder / kExperimentFile)) {
    return;
  }
  pair_sets::write_pair_set(folder / kPairsFile, set.pairs);
  if (!set.negatives.empty()) {
    pair_sets::write_negatives(folder / kNegativesFile, set.negatives);
  }
  storage::write_file_atomically(folder / kExperimentFile, internal::experiment_to_json(experiment));
}

/// Throws InputError unless the outcome is one of a pair that the experiment has.
void require_pair(const Outcome& outcome, const Experiment& experiment, const fs::path& file, std::size_t line) {
  const std::size_t pairs = experiment.pairs + experiment.negatives;
  if (outcome.pair >= pairs || outcome.negative != (outcome.pair >= experiment.pairs)) {
    throw InputError(file.string(), "line " + std::to_string(line),
                     "an outcome of pair " + std::to_string(outcome.pair) + ", but the set has " +
                         std::to_string(experiment.pairs) + " pairs and behind them " +
                         std::to_string(experiment.negatives) + " of different places",
                     "delete this file and run the shard again");
  }
}

/// Outcomes of all record files in a folder, the times put back in; the first record of a pair counts.
std::map<OutcomeKey, Outcome> read_outcomes(const fs::path& folder, const Experiment& experiment) {
  std::map<OutcomeKey, Outcome> outcomes;
  for (const fs::path& file : files_with_ending(folder / "shards", ".records")) {
    std::size_t number = 0;
    for (const std::string& line : storage::read_records(file).lines) {
      Outcome outcome = internal::outcome_from_line(line, file.string());
      require_pair(outcome, experiment, file, ++number);
      const OutcomeKey key{outcome.algorithm, outcome.pair};
      outcomes.emplace(key, std::move(outcome));
    }
  }
  for (const fs::path& file : files_with_ending(folder / "shards", ".times")) {
    for (const std::string& line : storage::read_records(file).lines) {
      const Outcome times = internal::times_from_line(line, file.string());
      const auto found = outcomes.find({times.algorithm, times.pair});
      if (found != outcomes.end()) {
        found->second.answer.timings = times.answer.timings;
        found->second.answer.paper_seconds = times.answer.paper_seconds;
        found->second.answer.total_seconds = times.answer.total_seconds;
      }
    }
  }
  return outcomes;
}

std::vector<Outcome> ordered(const std::map<OutcomeKey, Outcome>& outcomes, const Experiment& experiment) {
  std::vector<Outcome> list;
  for (const std::string& algorithm : experiment.algorithms) {
    for (auto at = outcomes.lower_bound({algorithm, 0}); at != outcomes.end() && at->first.first == algorithm; ++at) {
      list.push_back(at->second);
    }
  }
  return list;
}

/// Names the first pairs that are missing, or nothing.
std::string missing_pairs(const std::map<OutcomeKey, Outcome>& outcomes, const Experiment& experiment,
                          const EvaluatedSet& set) {
  std::string text;
  std::size_t missing = 0;
  for (const std::string& algorithm : experiment.algorithms) {
    for (std::size_t pair = 0; pair < set.size(); ++pair) {
      if (outcomes.count({algorithm, pair}) == 0 && ++missing <= 3) {
        text += (text.empty() ? "" : "; ") + algorithm + " on pair " + std::to_string(pair) + " (" +
                to_string(set.key(pair)) + ")";
      }
    }
  }
  return missing == 0 ? "" : std::to_string(missing) + " outcomes are missing: " + text + (missing > 3 ? "; ..." : "");
}

void require_complete(const fs::path& folder, const std::map<OutcomeKey, Outcome>& outcomes,
                      const Experiment& experiment, const EvaluatedSet& set) {
  const std::string missing = missing_pairs(outcomes, experiment, set);
  if (!missing.empty()) {
    throw InputError(folder.string(), "", missing, "run the missing shards again with the same command: they resume");
  }
}

/// Adds the algorithms that are not there yet. Throws InputError when one name stands for two settings.
void add_algorithms(Experiment& all, const Experiment& more) {
  for (std::size_t i = 0; i < more.algorithms.size(); ++i) {
    const auto place = std::find(all.algorithms.begin(), all.algorithms.end(), more.algorithms[i]);
    if (place == all.algorithms.end()) {
      all.algorithms.push_back(more.algorithms[i]);
      all.settings.push_back(more.settings[i]);
    } else if (all.settings[static_cast<std::size_t>(place - all.algorithms.begin())] != more.settings[i]) {
      throw InputError("two results have an algorithm " + more.algorithms[i] +
                       " with different settings: " + more.settings[i]);
    }
  }
}

}  // namespace

bool Experiment::same_task(const Experiment& other) const {
  return set_sha256 == other.set_sha256 && extra_sha256 == other.extra_sha256 && criterion == other.criterion;
}

Shard shard_from(const std::string& text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, shard.index);
  bool good = error == std::errc() && slash != end && *slash == '/';
  if (good) {
    const auto [stop, second] = std::from_chars(slash + 1, end, shard.count);
    good = second == std::errc() && stop == end && shard.index >= 1 && shard.index <= shard.count;
  }
  if (!good) {
    throw InputError("--shard " + text + ": not k/N with 1 <= k <= N");
  }
  return shard;
}

OutcomeWriter::OutcomeWriter(const fs::path& folder, const Experiment& experiment, const EvaluatedSet& set,
                             Shard shard) {
  std::error_code error;
  fs::create_directories(folder / "shards", error);
  if (error) {
    throw InputError(folder.string(), "", "cannot make this folder: " + error.message());
  }
  write_experiment(folder, experiment, set);
  const Experiment stored = read_experiment(folder);
  if (!stored.same_task(experiment) || stored.algorithms != experiment.algorithms ||
      stored.settings != experiment.settings) {
    throw InputError(folder.string(), "", "this folder holds another experiment",
                     "give another -o (loopmark evaluate merge joins results of one set)");
  }
  for (auto& [key, outcome] : read_outcomes(folder, experiment)) {
    done_.insert(key);
    found_.push_back(std::move(outcome));
  }
  sort_outcomes(found_, experiment.algorithms);
  records_ = std::make_unique<storage::RecordWriter>(folder / "shards" / (shard_name(shard) + ".records"));
  times_ = std::make_unique<storage::RecordWriter>(folder / "shards" / (shard_name(shard) + ".times"));
}

bool OutcomeWriter::done(const std::string& algorithm, std::size_t pair) const {
  const std::scoped_lock lock(mutex_);
  return done_.count({algorithm, pair}) > 0;
}

void OutcomeWriter::add(const Outcome& outcome) {
  const std::scoped_lock lock(mutex_);
  times_->append(internal::times_to_line(outcome));
  records_->append(internal::outcome_to_line(outcome));
  done_.insert({outcome.algorithm, outcome.pair});
}

StoredResult read_result(const fs::path& folder) {
  StoredResult result{read_experiment(folder), {}, {}};
  result.set = read_set(folder, result.experiment);
  const auto outcomes = read_outcomes(folder, result.experiment);
  require_complete(folder, outcomes, result.experiment, result.set);
  result.outcomes = ordered(outcomes, result.experiment);
  return result;
}

bool result_is_complete(const fs::path& folder) {
  const Experiment experiment = read_experiment(folder);
  return missing_pairs(read_outcomes(folder, experiment), experiment, read_set(folder, experiment)).empty();
}

StoredResult merge_results(const std::vector<fs::path>& folders, const fs::path& target) {
  StoredResult merged;
  std::map<OutcomeKey, Outcome> outcomes;
  for (const fs::path& folder : folders) {
    const Experiment experiment = read_experiment(folder);
    if (folder == folders.front()) {
      merged.experiment = experiment;
      merged.set = read_set(folder, experiment);
    } else if (!merged.experiment.same_task(experiment)) {
      throw InputError(folder.string(), "", "another set or criterion than " + folders.front().string(),
                       "only results of the same pairs can be joined");
    }
    add_algorithms(merged.experiment, experiment);
    outcomes.merge(read_outcomes(folder, experiment));
  }
  require_complete(folders.front(), outcomes, merged.experiment, merged.set);
  merged.outcomes = ordered(outcomes, merged.experiment);
  if (folders.size() > 1 || folders.front() != target) {
    OutcomeWriter writer(target, merged.experiment, merged.set, {});
    for (const Outcome& outcome : merged.outcomes) {
      if (!writer.done(outcome.algorithm, outcome.pair)) {
        writer.add(outcome);
      }
    }
  }
  write_products(target, merged);
  return merged;
}

void sort_outcomes(std::vector<Outcome>& outcomes, const std::vector<std::string>& names) {
  const auto rank = [&](const Outcome& outcome) {
    return std::find(names.begin(), names.end(), outcome.algorithm) - names.begin();
  };
  std::stable_sort(outcomes.begin(), outcomes.end(), [&](const Outcome& a, const Outcome& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.pair < b.pair;
  });
}

}  // namespace loopmark::evaluation
