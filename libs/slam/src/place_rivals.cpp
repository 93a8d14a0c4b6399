// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_rivals.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark {
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

std::vector<std::size_t> rivals_among(const std::vector<PlaceAnswer>& answers) {
  std::vector<std::size_t> rivals;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers[i].log_odds >= kMayBeThere) {
      rivals.push_back(i);
    }
  }
  return rivals;
}

void tell_rivals_apart(std::vector<PlaceAnswer>& answers, const std::vector<std::optional<double>>& verdicts) {
  const std::vector<std::size_t> rivals = rivals_among(answers);
  const bool judged = std::all_of(rivals.begin(), rivals.end(), [&](std::size_t i) { return verdicts[i].has_value(); });
  if (rivals.size() < 2 || !judged) {
    return;
  }
  std::vector<double> before;
  std::vector<double> said;
  for (const std::size_t i : rivals) {
    before.push_back(answers[i].log_odds);
    said.push_back(*verdicts[i]);
  }
  const double change = log_of_sum(before) - log_of_sum(said);
  for (const std::size_t i : rivals) {
    answers[i].log_odds = *verdicts[i] + change;
  }
}

}  // namespace loopmark
