// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The choice of a balanced set from a pool of candidates.
#pragma once

#include <map>
#include <vector>

#include "loopmark/pair_sets/balance_options.hpp"
#include "loopmark/pair_sets/pair_set.hpp"

namespace loopmark::pair_sets {

/// How the choice went.
struct SelectionReport {
  std::size_t draws = 0;                          ///< places drawn in the cube
  std::map<int, std::size_t> candidates, chosen;  ///< by session
};

/// The selection of the paper (Sec. 3): motions x y z roll pitch yaw are normalised to the unit cube over the
/// candidates that remain, again after each pick; a place is drawn uniformly; of the candidates within the radius,
/// those of the drive with the least share chosen so far are kept, and the nearest of them is picked; with none within
/// the radius the place is drawn again. Axes on which all candidates agree are left out. Returns at most `count`
/// pairs, sorted by session and source; fewer when the pool ends or draws keep missing.
std::vector<RegistrationPair> select_balanced(const std::vector<RegistrationPair>& pool, std::size_t count,
                                              const BalanceOptions& options, SelectionReport* report = nullptr);

}  // namespace loopmark::pair_sets
