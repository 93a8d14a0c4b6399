// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Candidates for balanced sets: pairs of frames that share enough of what they see.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "loopmark/cloud/overlap.hpp"
#include "loopmark/core/point_cloud.hpp"
#include "loopmark/pair_sets/balance_options.hpp"
#include "loopmark/pair_sets/pair_set.hpp"

namespace loopmark::pair_sets {

/// One drive that pairs may come from.
struct Drive {
  int session = 0;
  std::string name;
  std::vector<int> frames;                            ///< the numbers that the data set gives to the frames, in order
  std::vector<double> stamps_s;                       ///< as long
  std::vector<Pose> T_world_cloud;                    ///< as long: reference poses
  std::function<PointCloud(std::size_t place)> load;  ///< thread-safe

  std::size_t size() const { return frames.size(); }
};

/// Throws InputError when a drive has no reference poses or its stamps do not rise.
void check(const Drive& drive);

/// What the pool has cost.
struct PoolCost {
  std::size_t overlaps = 0;  ///< overlaps computed in this run
  std::size_t scans = 0;     ///< scans read in this run
  double seconds = 0.0;
};

/// Every k-th frame of all drives is a source, k = max(1, frames / (candidates_per_pair * pairs)).
std::size_t source_spacing(const std::vector<Drive>& drives, std::size_t pairs, const BalanceOptions& options);

/// The pool of the paper: for every source the farthest frame with enough overlap, at most max_gap_s ahead, is found
/// by trying the spacing of the source before, then by bisection; the target is drawn uniformly up to it. The same
/// pool for any number of threads. With `records` the blocks that are done are kept there and not done again.
std::vector<RegistrationPair> make_candidate_pool(const std::vector<Drive>& drives, std::size_t pairs,
                                                  const BalanceOptions& options,
                                                  const std::filesystem::path& records = {}, PoolCost* cost = nullptr);

/// Candidates that the published sets lack: the target was seen more than max_gap_s before or after the source, or
/// in another drive (drives share a world when `one_world`), from any direction.
std::vector<RegistrationPair> make_revisit_pool(const std::vector<Drive>& drives, std::size_t pairs, bool one_world,
                                                const BalanceOptions& options);

}  // namespace loopmark::pair_sets
