// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/binary_energy.hpp"

#include <gtest/gtest.h>

#include <array>

#include "loopmark/core/random.hpp"

namespace loopmark::estimation {
namespace {

struct Pair {
  std::size_t p, q;
  std::array<double, 4> e;  // e00, e01, e10, e11
};

TEST(BinaryEnergy, FindsTheMinimumOfAllLabellings) {
  constexpr std::size_t kVariables = 9;
  Rng rng(1);
  for (int trial = 0; trial < 60; ++trial) {
    std::array<double, kVariables> unary{};
    std::vector<Pair> pairs;
    BinaryEnergy energy(kVariables);
    for (std::size_t v = 0; v < kVariables; ++v) {
      unary[v] = rng.uniform(-1, 1);
      energy.add_unary(v, unary[v]);
    }
    for (int k = 0; k < 14; ++k) {
      const std::size_t p = rng.below(kVariables);
      const std::size_t q = (p + 1 + rng.below(kVariables - 1)) % kVariables;
      const double e00 = rng.uniform();
      const double e11 = rng.uniform();
      const double e01 = rng.uniform();
      const double e10 = std::max(0.0, e00 + e11 - e01) + rng.uniform();
      pairs.push_back({p, q, {e00, e01, e10, e11}});
      energy.add_pair(p, q, e00, e01, e10, e11);
    }
    const auto cost = [&](const auto& value) {
      double sum = 0.0;
      for (std::size_t v = 0; v < kVariables; ++v) {
        sum += value(v) ? unary[v] : 0.0;
      }
      for (const Pair& pair : pairs) {
        sum += pair.e[(value(pair.p) ? 2U : 0U) + (value(pair.q) ? 1U : 0U)];
      }
      return sum;
    };
    double least = 1e9;
    for (unsigned mask = 0; mask < 1U << kVariables; ++mask) {
      least = std::min(least, cost([&](std::size_t v) { return (mask >> v & 1U) != 0; }));
    }
    const std::vector<bool> labels = energy.minimise();
    EXPECT_NEAR(cost([&](std::size_t v) { return static_cast<bool>(labels[v]); }), least, 1e-9);
  }
}

}  // namespace
}  // namespace loopmark::estimation
