// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>

#include "loopmark/pair_sets/candidate_pool.hpp"

namespace loopmark::pair_sets::internal {

/// Overlaps of one source frame with others, by the paper's definition to the letter.
class OverlapProbe {
 public:
  OverlapProbe(const Drive& drive, std::size_t place, PoolCost& cost);

  /// Overlap with a frame of any drive, the source moved by the reference poses.
  cloud::Overlap with(const Drive& target_drive, std::size_t target);

  Pose T_target_source(const Drive& target_drive, std::size_t target) const {
    return target_drive.T_world_cloud[target].inverse() * drive_.T_world_cloud[place_];
  }
  RegistrationPair pair(const Drive& target_drive, std::size_t target, const cloud::Overlap& overlap) const;

 private:
  const Drive& drive_;
  std::size_t place_;
  PointCloud source_;
  PoolCost& cost_;
};

/// The overlap that options.min_overlap speaks of.
inline double chosen(const cloud::Overlap& overlap, const BalanceOptions& options) {
  return options.symmetric ? overlap.symmetric : overlap.source;
}

}  // namespace loopmark::pair_sets::internal
