// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/random.hpp"

#include <cmath>
#include <numbers>

namespace loopmark {
namespace {

std::uint64_t split_mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

constexpr std::uint64_t kIncrement = 1442695040888963407ULL;

}  // namespace

std::uint64_t task_seed(std::uint64_t seed, std::initializer_list<std::uint64_t> task) {
  std::uint64_t mixed = split_mix(seed);
  for (const std::uint64_t number : task) {
    mixed = split_mix(mixed ^ split_mix(number + 0x632be59bd9b4e019ULL));
  }
  return mixed;
}

Rng::Rng(std::uint64_t seed) : state_(split_mix(seed)) {}

std::uint32_t Rng::next() {
  const std::uint64_t old = state_;
  state_ = old * 6364136223846793005ULL + kIncrement;
  const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
  const auto turn = static_cast<std::uint32_t>(old >> 59U);
  return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
}

std::uint32_t Rng::below(std::uint32_t bound) {
  const std::uint32_t threshold = (0U - bound) % bound;
  while (true) {
    const std::uint32_t r = next();
    if (r >= threshold) {
      return r % bound;
    }
  }
}

double Rng::uniform() {
  const std::uint64_t high = next() >> 5U;
  const std::uint64_t low = next() >> 6U;
  return (static_cast<double>(high) * 67108864.0 + static_cast<double>(low)) / 9007199254740992.0;
}

double Rng::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

}  // namespace loopmark
