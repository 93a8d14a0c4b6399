// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "loopmark/core/random.hpp"
#include "loopmark/estimation/ransac.hpp"

namespace loopmark::estimation::internal {

/// Three different numbers below a bound.
inline void draw_distinct(Rng& rng, std::size_t bound, std::size_t (&triple)[3], std::size_t drawn = 0) {
  while (drawn < 3) {
    const std::size_t next = rng.below(static_cast<std::uint32_t>(bound));
    bool fresh = true;
    for (std::size_t k = 0; k < drawn; ++k) {
      fresh = fresh && triple[k] != next;
    }
    if (fresh) {
      triple[drawn++] = next;
    }
  }
}

/// Draws minimal sets, uniformly or as PROSAC does (Chum and Matas 2005, Sec. 2, growth function of eq. 3-5): from a
/// pool of the best matches that grows as if uniform sampling took its samples in the order of their quality.
class TripleSampler {
 public:
  TripleSampler(Sampler kind, std::size_t count, std::size_t growth)
      : prosac_(kind == Sampler::kProsac), count_(count), growth_(static_cast<double>(growth)) {
    samples_of_pool_ = growth_;
    for (std::size_t i = 0; i < 3; ++i) {
      samples_of_pool_ *= static_cast<double>(3 - i) / static_cast<double>(count_ - i);
    }
  }

  void draw(Rng& rng, std::size_t (&triple)[3]) {
    ++drawn_;
    if (!prosac_ || static_cast<double>(drawn_) > growth_) {
      draw_distinct(rng, count_, triple);
      return;
    }
    while (drawn_ >= until_ && pool_ < count_) {
      grow();
    }
    if (until_ < drawn_) {
      draw_distinct(rng, pool_, triple);
      return;
    }
    // The newest of the pool and two others.
    triple[0] = pool_ - 1;
    draw_distinct(rng, pool_, triple, 1);
  }

  std::size_t pool() const { return pool_; }

 private:
  void grow() {
    const double next = samples_of_pool_ * static_cast<double>(pool_ + 1) / static_cast<double>(pool_ - 2);
    until_ += static_cast<std::size_t>(std::ceil(next - samples_of_pool_));
    samples_of_pool_ = next;
    ++pool_;
  }

  bool prosac_;
  std::size_t count_;
  double growth_;
  double samples_of_pool_ = 0.0;  ///< T_n
  std::size_t pool_ = 3;          ///< n
  std::size_t until_ = 1;         ///< T'_n
  std::size_t drawn_ = 0;         ///< t
};

}  // namespace loopmark::estimation::internal
