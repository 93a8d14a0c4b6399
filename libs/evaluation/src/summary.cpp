// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace loopmark::evaluation {
namespace {

/// Bins between the edges; the last includes its upper edge.
std::vector<RecallBin> binned(const std::vector<Outcome>& outcomes, const std::vector<double>& edges,
                              const std::function<double(std::size_t)>& value) {
  std::vector<RecallBin> bins;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    bins.push_back({edges[i], edges[i + 1], 0, 0});
  }
  for (const Outcome& outcome : outcomes) {
    if (outcome.negative) {
      continue;
    }
    const double x = value(outcome.pair);
    for (std::size_t i = 0; i < bins.size(); ++i) {
      if (x >= bins[i].low && (x < bins[i].high || (i + 1 == bins.size() && x <= bins[i].high))) {
        ++bins[i].pairs;
        bins[i].successes += outcome.success ? 1 : 0;
      }
    }
  }
  return bins;
}

void add_bins(AlgorithmSummary& summary, const std::vector<Outcome>& outcomes, const EvaluatedSet& set) {
  summary.by_overlap =
      binned(outcomes, {0.0, 0.2, 0.35, 0.5, 0.7, 1.0}, [&](std::size_t p) { return set.pairs[p].overlap_symmetric; });
  summary.by_distance = binned(outcomes, {0.0, 5.0, 10.0, 20.0, 30.0, 50.0, 75.0, 1000.0},
                               [&](std::size_t p) { return set.pairs[p].motion.head<3>().norm(); });
  summary.by_yaw = binned(outcomes, {0.0, 5.0, 20.0, 45.0, 90.0, 180.0},
                          [&](std::size_t p) { return std::abs(set.pairs[p].motion[5]); });
}

void add_errors(AlgorithmSummary& summary, const std::vector<Outcome>& outcomes) {
  std::vector<double> te, re, te_success, re_success;
  for (const Outcome& outcome : outcomes) {
    if (outcome.negative) {
      continue;
    }
    te.push_back(outcome.error.translation_m);
    re.push_back(outcome.error.rotation_deg);
    if (outcome.success) {
      te_success.push_back(outcome.error.translation_m);
      re_success.push_back(outcome.error.rotation_deg);
    }
  }
  const auto median = [](const std::vector<double>& values) { return statistics::quantile(values, 0.5); };
  summary.te_m = statistics::spread_of(te);
  summary.re_deg = statistics::spread_of(re);
  summary.te_success_m = statistics::spread_of(te_success);
  summary.re_success_deg = statistics::spread_of(re_success);
  constexpr std::size_t kRepeats = 200;
  summary.te_median_interval_m = statistics::bootstrap_interval(te, median, kRepeats);
  summary.re_median_interval_deg = statistics::bootstrap_interval(re, median, kRepeats);
}

/// Collects named values in the order in which the names are first seen.
class NamedValues {
 public:
  void add(const std::string& name, double value) {
    const auto [place, added] = index_.emplace(name, values_.size());
    if (added) {
      values_.emplace_back(name, std::vector<double>{});
    }
    values_[place->second].second.push_back(value);
  }
  std::vector<std::pair<std::string, double>> reduced(
      const std::function<double(const std::vector<double>&)>& f) const {
    std::vector<std::pair<std::string, double>> out;
    for (const auto& [name, values] : values_) {
      out.emplace_back(name, f(values));
    }
    return out;
  }

 private:
  std::map<std::string, std::size_t> index_;
  std::vector<std::pair<std::string, std::vector<double>>> values_;
};

void add_times(AlgorithmSummary& summary, const std::vector<Outcome>& outcomes) {
  std::vector<double> paper, total;
  NamedValues stages, numbers;
  for (const Outcome& outcome : outcomes) {
    if (!std::isnan(outcome.answer.paper_seconds)) {
      paper.push_back(outcome.answer.paper_seconds);
    }
    if (!std::isnan(outcome.answer.total_seconds)) {
      total.push_back(outcome.answer.total_seconds);
    }
    for (const registration::StageTime& stage : outcome.answer.timings) {
      stages.add(stage.stage, stage.seconds);
    }
    if (!outcome.negative) {
      for (const auto& [name, value] : outcome.answer.numbers) {
        numbers.add(name, value);
      }
    }
  }
  summary.paper_seconds = statistics::spread_of(paper);
  summary.total_seconds = statistics::spread_of(total);
  summary.stage_medians_s = stages.reduced([](const std::vector<double>& v) { return statistics::quantile(v, 0.5); });
  summary.number_means = numbers.reduced([](const std::vector<double>& v) { return statistics::spread_of(v).mean; });
}

void add_counts(AlgorithmSummary& summary, const std::vector<Outcome>& outcomes) {
  for (const Outcome& outcome : outcomes) {
    const bool answered = outcome.answer.status == AnswerStatus::kAnswered;
    if (outcome.negative) {
      ++summary.negatives;
      summary.false_accepts += answered ? 1 : 0;
      continue;
    }
    ++summary.pairs;
    summary.successes += outcome.success ? 1 : 0;
    summary.answered += answered ? 1 : 0;
    summary.answered_wrong += answered && !outcome.success ? 1 : 0;
    summary.failed += outcome.answer.has_motion() ? 0 : 1;
  }
  summary.recall_interval = statistics::wilson_interval(summary.successes, summary.pairs);
  summary.false_accept_interval = statistics::wilson_interval(summary.false_accepts, summary.negatives);
}

void add_calibration(AlgorithmSummary& summary, const std::vector<Outcome>& outcomes) {
  std::vector<statistics::Judged> judged;
  bool probabilities = true;
  for (const Outcome& outcome : outcomes) {
    const double p = outcome.answer.p_correct;
    if (!std::isnan(p) && outcome.answer.has_motion()) {
      judged.push_back({p, outcome.success});
      probabilities = probabilities && p >= 0.0 && p <= 1.0;
    }
  }
  summary.has_scores = !judged.empty();
  if (summary.has_scores) {
    summary.precision_recall = statistics::precision_recall(judged, summary.pairs);
    summary.average_precision = statistics::average_precision(summary.precision_recall);
  }
  if (summary.has_scores && probabilities) {
    summary.reliability = statistics::reliability_table(judged);
    summary.calibration_error = statistics::expected_calibration_error(summary.reliability);
  }
}

}  // namespace

AlgorithmSummary summarise(const std::vector<Outcome>& unsorted, const EvaluatedSet& set) {
  std::vector<Outcome> outcomes = unsorted;
  std::sort(outcomes.begin(), outcomes.end(), [](const Outcome& a, const Outcome& b) { return a.pair < b.pair; });
  AlgorithmSummary summary;
  summary.name = outcomes.empty() ? "" : outcomes.front().algorithm;
  add_counts(summary, outcomes);
  add_errors(summary, outcomes);
  add_times(summary, outcomes);
  add_calibration(summary, outcomes);
  add_bins(summary, outcomes, set);
  return summary;
}

std::vector<AlgorithmSummary> summarise_all(const std::vector<Outcome>& outcomes, const std::vector<std::string>& names,
                                            const EvaluatedSet& set) {
  std::vector<AlgorithmSummary> summaries;
  for (const std::string& name : names) {
    std::vector<Outcome> own;
    std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(own),
                 [&](const Outcome& outcome) { return outcome.algorithm == name; });
    summaries.push_back(summarise(own, set));
    summaries.back().name = name;
  }
  return summaries;
}

PairedTest paired_test(const std::vector<Outcome>& outcomes, const std::string& first, const std::string& second) {
  std::map<std::size_t, bool> successes;
  for (const Outcome& outcome : outcomes) {
    if (outcome.algorithm == first && !outcome.negative) {
      successes[outcome.pair] = outcome.success;
    }
  }
  PairedTest test{first, second, 0, 0, 0, 0, 1.0};
  for (const Outcome& outcome : outcomes) {
    const auto other = successes.find(outcome.pair);
    if (outcome.algorithm != second || outcome.negative || other == successes.end()) {
      continue;
    }
    std::size_t& count = other->second ? (outcome.success ? test.both : test.only_first)
                                       : (outcome.success ? test.only_second : test.neither);
    ++count;
  }
  test.p_value = statistics::mcnemar_p_value(test.only_first, test.only_second);
  return test;
}

std::vector<PairedTest> paired_tests(const std::vector<Outcome>& outcomes, const std::vector<std::string>& names) {
  std::vector<PairedTest> tests;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      tests.push_back(paired_test(outcomes, names[i], names[j]));
    }
  }
  return tests;
}

}  // namespace loopmark::evaluation
