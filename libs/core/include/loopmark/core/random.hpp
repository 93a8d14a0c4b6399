// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Random numbers that depend only on a seed and on what is being worked on, the same on every platform.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace loopmark {

/// A seed for one task, made from the run's seed and the numbers that name the task (a pair, a keyframe).
std::uint64_t task_seed(std::uint64_t seed, std::initializer_list<std::uint64_t> task);

/// PCG32 (O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms", 2014).
class Rng {
 public:
  explicit Rng(std::uint64_t seed);

  std::uint32_t next();
  /// Uniform integer in [0, bound), without bias; bound > 0.
  std::uint32_t below(std::uint32_t bound);
  /// Uniform in [0, 1).
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box-Muller).
  double normal();

 private:
  std::uint64_t state_ = 0;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace loopmark
