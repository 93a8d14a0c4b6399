// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/experiment.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/number_rows.hpp"

namespace loopmark::evaluation {
namespace {

std::string hash_of_set(const std::vector<pair_sets::RegistrationPair>& pairs) {
  std::string text;
  for (const pair_sets::RegistrationPair& pair : pairs) {
    text += to_string(pair.key);
    text::append_motion(text, pair.T_target_source);
    text += '\n';
  }
  return storage::sha256_hex(text);
}

std::string hash_of_extras(const ExperimentTask& task) {
  std::string text;
  for (const pair_sets::PairKey& key : task.set.negatives) {
    text += to_string(key) + '\n';
  }
  for (const Pose& pose : task.perturbations) {
    text::append_motion(text, pose);
  }
  return storage::sha256_hex(text);
}

/// Recall so far, for the progress line.
class RecallSoFar {
 public:
  void add(const Outcome& outcome) {
    if (!outcome.negative) {
      ++count_;
      successes_ += outcome.success ? 1 : 0;
    }
  }
  std::string text() const {
    if (count_ == 0) {
      return "";
    }
    return format_text("recall %.1f %%", 100.0 * static_cast<double>(successes_) / static_cast<double>(count_));
  }

 private:
  std::size_t count_ = 0;
  std::size_t successes_ = 0;
};

/// One run: the pairs that are left, and the threads that take them.
class Run {
 public:
  Run(const ExperimentTask& task, const AlgorithmList& algorithms, const ScanLoader& load, OutcomeWriter& writer)
      : task_(task),
        algorithms_(algorithms),
        load_(load),
        writer_(writer),
        todo_(pairs_left()),
        progress_("evaluation", "pairs", todo_.size()) {
    for (const Outcome& outcome : writer.found()) {
      recall_.add(outcome);
      found_[outcome.pair].emplace(outcome.algorithm, outcome.answer);
    }
  }

  void all() {
    const std::size_t workers = std::clamp<std::size_t>(task_.pairs_at_once, 1, std::max<std::size_t>(todo_.size(), 1));
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < workers; ++i) {
      threads.emplace_back([this] { work(); });
    }
    work();
    for (std::thread& thread : threads) {
      thread.join();
    }
    if (error_) {
      std::rethrow_exception(error_);
    }
    check_interrupt();
  }

 private:
  std::vector<std::size_t> pairs_left() const {
    std::vector<std::size_t> pairs;
    for (std::size_t pair = 0; pair < task_.set.size(); ++pair) {
      const bool left = std::any_of(algorithms_.begin(), algorithms_.end(),
                                    [&](const auto& algorithm) { return !writer_.done(algorithm->name(), pair); });
      if (task_.shard.holds(pair) && left) {
        pairs.push_back(pair);
      }
    }
    return pairs;
  }

  void work() {
    while (!stop_ && !interrupt_requested()) {
      const std::size_t next = next_.fetch_add(1);
      if (next >= todo_.size()) {
        return;
      }
      try {
        one_pair(todo_[next]);
      } catch (...) {
        const std::scoped_lock lock(mutex_);
        error_ = error_ ? error_ : std::current_exception();
        stop_ = true;
      }
    }
  }

  void one_pair(std::size_t index) {
    std::map<std::string, Answer> answers;
    const auto before = found_.find(index);
    if (before != found_.end()) {
      answers = before->second;
    }
    const std::unique_ptr<PairScans> scans = needs_scans(index) ? load_scans(index) : nullptr;
    for (const auto& algorithm : algorithms_) {
      if (!writer_.done(algorithm->name(), index)) {
        check_interrupt();
        Answer answer = algorithm->answer({index, task_.set.key(index), scans.get(), perturbation(index), &answers});
        answers[algorithm->name()] = answer;
        record(judged(index, algorithm->name(), std::move(answer)));
      }
    }
    const std::scoped_lock lock(mutex_);
    progress_.add(1, recall_.text());
  }

  std::unique_ptr<PairScans> load_scans(std::size_t index) const {
    const pair_sets::PairKey& key = task_.set.key(index);
    PointCloud source = load_(key.session, key.source);
    if (const Pose* moved = perturbation(index)) {
      source = transformed(source, *moved);
    }
    return std::make_unique<PairScans>(std::move(source), load_(key.target_session, key.target));
  }

  const Pose* perturbation(std::size_t index) const {
    return index < task_.perturbations.size() ? &task_.perturbations[index] : nullptr;
  }

  bool needs_scans(std::size_t index) const {
    return std::any_of(algorithms_.begin(), algorithms_.end(), [&](const auto& algorithm) {
      return algorithm->needs_scans() && !writer_.done(algorithm->name(), index);
    });
  }

  Outcome judged(std::size_t index, const std::string& algorithm, Answer answer) const {
    if (index >= task_.set.pairs.size()) {
      return judge_negative(index, algorithm, std::move(answer));
    }
    return judge(index, algorithm, std::move(answer), task_.set.pairs[index].T_target_source, task_.criterion);
  }

  void record(const Outcome& outcome) {
    writer_.add(outcome);
    const std::scoped_lock lock(mutex_);
    recall_.add(outcome);
  }

  const ExperimentTask& task_;
  const AlgorithmList& algorithms_;
  const ScanLoader& load_;
  OutcomeWriter& writer_;
  std::vector<std::size_t> todo_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
  RecallSoFar recall_;
  std::map<std::size_t, std::map<std::string, Answer>> found_;
  Progress progress_;
};

}  // namespace

Experiment describe_experiment(const ExperimentTask& task, const AlgorithmList& algorithms) {
  Experiment experiment;
  experiment.set_name = task.set_name;
  experiment.set_sha256 = hash_of_set(task.set.pairs);
  experiment.extra_sha256 = hash_of_extras(task);
  experiment.pairs = task.set.pairs.size();
  experiment.negatives = task.set.negatives.size();
  experiment.criterion = task.criterion;
  for (const auto& algorithm : algorithms) {
    const auto& names = experiment.algorithms;
    if (std::find(names.begin(), names.end(), algorithm->name()) != names.end()) {
      throw InputError("two algorithms are called " + algorithm->name() + "; give them names (NAME=...)");
    }
    experiment.algorithms.push_back(algorithm->name());
    experiment.settings.push_back(algorithm->settings());
  }
  return experiment;
}

void run_experiment(const ExperimentTask& task, const AlgorithmList& algorithms, const ScanLoader& load,
                    const std::filesystem::path& folder) {
  check(task.criterion);
  OutcomeWriter writer(folder, describe_experiment(task, algorithms), task.set, task.shard);
  Run(task, algorithms, load, writer).all();
}

}  // namespace loopmark::evaluation
