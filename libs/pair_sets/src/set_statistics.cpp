// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pair_sets/set_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/core/random.hpp"
#include "loopmark/statistics/statistics.hpp"

namespace loopmark::pair_sets {
namespace {

std::vector<double> values_of(const std::vector<RegistrationPair>& pairs,
                              const std::function<double(const RegistrationPair&)>& value) {
  std::vector<double> values;
  values.reserve(pairs.size());
  for (const RegistrationPair& pair : pairs) {
    values.push_back(value(pair));
  }
  return values;
}

double distance_of(const RegistrationPair& pair) { return pair.motion.head<3>().norm(); }
double yaw_of(const RegistrationPair& pair) { return std::abs(pair.motion[5]); }

std::string three(const std::vector<double>& values, double a, double b, double c, int decimals) {
  return text::fixed(statistics::quantile(values, a), decimals) + " / " +
         text::fixed(statistics::quantile(values, b), decimals) + " / " +
         text::fixed(statistics::quantile(values, c), decimals);
}

/// Some pairs of the pool, drawn without replacement.
std::vector<RegistrationPair> random_choice(std::vector<RegistrationPair> pool, std::size_t count, Rng& rng) {
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(pool[i], pool[i + rng.below(static_cast<std::uint32_t>(pool.size() - i))]);
  }
  pool.resize(count);
  return pool;
}

}  // namespace

const std::vector<PairQuantity>& pair_quantities() {
  static const std::vector<PairQuantity> quantities = {
      {"distance (m)", {0, 5, 10, 20, 30, 40, 50, 60, 80, 120}, distance_of},
      {"time offset (frames)",
       {0, 25, 50, 100, 200, 300, 400, 600, 1200},
       [](const RegistrationPair& p) { return std::abs(static_cast<double>(p.key.target - p.key.source)); }},
      {"symmetric overlap",
       {0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0},
       [](const RegistrationPair& p) { return p.overlap_symmetric; }},
      {"|roll| (deg)", {0, 0.5, 1, 2, 3, 5, 10}, [](const RegistrationPair& p) { return std::abs(p.motion[3]); }},
      {"|pitch| (deg)", {0, 0.5, 1, 2, 3, 5, 10}, [](const RegistrationPair& p) { return std::abs(p.motion[4]); }},
      {"|yaw| (deg)", {0, 5, 10, 20, 45, 90, 135, 180}, yaw_of}};
  return quantities;
}

std::vector<std::size_t> counts_in_bins(const std::vector<RegistrationPair>& pairs, const PairQuantity& quantity) {
  std::vector<std::size_t> counts(quantity.edges.size() - 1);
  for (const RegistrationPair& pair : pairs) {
    const auto above = std::upper_bound(quantity.edges.begin(), quantity.edges.end(), quantity.value(pair));
    const auto bin = std::clamp<std::ptrdiff_t>(above - quantity.edges.begin() - 1, 0,
                                                static_cast<std::ptrdiff_t>(counts.size()) - 1);
    ++counts[static_cast<std::size_t>(bin)];
  }
  return counts;
}

text::TextTable set_overview(const std::vector<std::pair<std::string, std::vector<RegistrationPair>>>& sets) {
  text::TextTable table{"sets",
                        "Sets",
                        {"Set", "Pairs", "Distance median / p90 / max (m)", "|yaw| median / p90 / max (deg)",
                         "Symmetric overlap p10 / median / p90"},
                        {},
                        ""};
  for (const auto& [name, pairs] : sets) {
    table.rows.push_back(
        {name, std::to_string(pairs.size()), three(values_of(pairs, distance_of), 0.5, 0.9, 1.0, 1),
         three(values_of(pairs, yaw_of), 0.5, 0.9, 1.0, 1),
         three(values_of(pairs, [](const auto& p) { return p.overlap_symmetric; }), 0.1, 0.5, 0.9, 2)});
  }
  return table;
}

text::TextTable strata_table(const std::vector<RegistrationPair>& pairs) {
  text::TextTable table{
      "strata", "Pairs by what makes them hard", {"Quantity", "From", "To", "Pairs", "Share"}, {}, ""};
  for (const PairQuantity& quantity : pair_quantities()) {
    const auto counts = counts_in_bins(pairs, quantity);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const int decimals = quantity.edges.back() <= 10.0 ? 1 : 0;
      table.rows.push_back(
          {quantity.name, text::fixed(quantity.edges[i], decimals), text::fixed(quantity.edges[i + 1], decimals),
           std::to_string(counts[i]),
           text::percent(static_cast<double>(counts[i]) / static_cast<double>(std::max<std::size_t>(1, pairs.size())),
                         1)});
    }
  }
  return table;
}

double motion_unevenness(const std::vector<RegistrationPair>& set, const std::vector<RegistrationPair>& pool,
                         int axis) {
  constexpr std::size_t kBins = 20;
  double low = pool.front().motion[axis];
  double high = low;
  for (const RegistrationPair& pair : pool) {
    low = std::min(low, pair.motion[axis]);
    high = std::max(high, pair.motion[axis]);
  }
  std::vector<std::size_t> counts(kBins);
  for (const RegistrationPair& pair : set) {
    const double at = high > low ? (pair.motion[axis] - low) / (high - low) : 0.0;
    ++counts[std::min(static_cast<std::size_t>(at * kBins), kBins - 1)];
  }
  return statistics::unevenness(counts);
}

text::TextTable evenness_table(const std::vector<RegistrationPair>& set, const std::vector<RegistrationPair>& pool,
                               std::uint64_t seed) {
  text::TextTable table{"evenness",
                        "How uneven the motions are (chi-square / degrees of freedom, 20 bins; lower is more even)",
                        {"Axis", "This set", "Random choice from the candidates"},
                        {},
                        ""};
  if (set.empty()) {
    return table;
  }
  Rng rng(task_seed(seed, {0x6576656eU}));
  std::vector<std::vector<RegistrationPair>> draws;
  for (int i = 0; i < 20; ++i) {
    draws.push_back(random_choice(pool, set.size(), rng));
  }
  for (const auto& [name, axis] : {std::pair{"x", 0}, std::pair{"y", 1}, std::pair{"yaw", 5}}) {
    std::vector<double> random;
    for (const auto& draw : draws) {
      random.push_back(motion_unevenness(draw, pool, axis));
    }
    table.rows.push_back(
        {name, text::fixed(motion_unevenness(set, pool, axis), 2), text::fixed(statistics::quantile(random, 0.5), 2)});
  }
  return table;
}

text::TextTable fairness_table(const SelectionReport& report) {
  text::TextTable table{"fairness", "Drives", {"Session", "Candidates", "Chosen", "Share"}, {}, ""};
  for (const auto& [session, candidates] : report.candidates) {
    const std::size_t chosen = report.chosen.at(session);
    table.rows.push_back({std::to_string(session), std::to_string(candidates), std::to_string(chosen),
                          text::percent(static_cast<double>(chosen) / static_cast<double>(candidates), 1)});
  }
  return table;
}

}  // namespace loopmark::pair_sets
