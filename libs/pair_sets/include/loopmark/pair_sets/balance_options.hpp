// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "loopmark/core/options.hpp"

namespace loopmark::pair_sets {

/// The generator of balanced sets (paper, Sec. 3); the defaults are the published ones.
struct BalanceOptions {
  double min_overlap = 0.2;
  bool symmetric = true;
  double radius = 0.1;
  std::size_t candidates_per_pair = 4;
  double max_gap_s = 60.0;
  double revisit_distance_m = 60.0;
  double negative_distance_m = 150.0;
  std::uint64_t seed = 0;
};

template <class Visitor>
void describe(Visitor& v, BalanceOptions& o) {
  v.field("min_overlap", o.min_overlap, "least overlap of a pair (paper: 0.2)");
  v.field("symmetric", o.symmetric, "min_overlap is of the symmetric overlap");
  v.field("radius", o.radius, "radius in the normalised cube of motions (paper: 0.1)");
  v.field("candidates_per_pair", o.candidates_per_pair, "size of the candidate pool for each pair asked for");
  v.field("max_gap_s", o.max_gap_s, "the target comes at most this long after the source; revisits come later");
  v.field("revisit_distance_m", o.revisit_distance_m, "revisits are looked for within this distance");
  v.field("negative_distance_m", o.negative_distance_m, "hard negatives are at least this far apart");
  v.field("seed", o.seed, "seed of everything random");
}
void check(const BalanceOptions& options);

}  // namespace loopmark::pair_sets
