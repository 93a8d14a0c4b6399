// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Pairs of scans that look alike and show different places.
#pragma once

#include <vector>

#include "loopmark/pair_sets/candidate_pool.hpp"

namespace loopmark::pair_sets {

/// What a scan looks like from any heading: for each of 20 rings up to 80 m, mean and spread over 60 sectors of the
/// highest point above the scan's ground level (metres, ground taken as the 10th percentile of heights). In the manner
/// of ring keys (Kim and Kim, "Scan Context", IROS 2018).
std::vector<float> ring_descriptor(const std::vector<Eigen::Vector3f>& points);

/// For frames spread over the drives, the frame that looks most alike among those at least negative_distance_m away
/// and without any overlap; the `count` most alike pairs, no frame twice. Frames of different drives count only when
/// the drives share a world.
std::vector<PairKey> find_hard_negatives(const std::vector<Drive>& drives, std::size_t count, bool one_world,
                                         const BalanceOptions& options);

}  // namespace loopmark::pair_sets
