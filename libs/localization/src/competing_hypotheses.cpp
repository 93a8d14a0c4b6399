// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "competing_hypotheses.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark::localization::internal {
namespace {

constexpr double kMayBeThere = -3.0;

}  // namespace

double log_of_sum(const std::vector<double>& log_odds) {
  const double highest = *std::max_element(log_odds.begin(), log_odds.end());
  double sum = 0.0;
  for (const double x : log_odds) {
    sum += std::exp(x - highest);
  }
  return highest + std::log(sum);
}

std::vector<std::size_t> competing_among(const std::vector<LocalizationHypothesis>& answers) {
  std::vector<std::size_t> competitors;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers[i].log_odds >= kMayBeThere) {
      competitors.push_back(i);
    }
  }
  return competitors;
}

void separate_competing_hypotheses(std::vector<LocalizationHypothesis>& answers,
                                   const std::vector<std::optional<double>>& verdicts) {
  const std::vector<std::size_t> competitors = competing_among(answers);
  const bool judged =
      std::all_of(competitors.begin(), competitors.end(), [&](std::size_t i) { return verdicts[i].has_value(); });
  if (competitors.size() < 2 || !judged) {
    return;
  }
  std::vector<double> before;
  std::vector<double> said;
  for (const std::size_t i : competitors) {
    before.push_back(answers[i].log_odds);
    said.push_back(*verdicts[i]);
  }
  const double change = log_of_sum(before) - log_of_sum(said);
  for (const std::size_t i : competitors) {
    answers[i].log_odds = *verdicts[i] + change;
  }
}

}  // namespace loopmark::localization::internal
