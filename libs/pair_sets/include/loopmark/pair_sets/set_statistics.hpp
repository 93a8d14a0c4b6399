// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What is in a set of pairs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "loopmark/pair_sets/balanced_selection.hpp"
#include "loopmark/text/text_table.hpp"

namespace loopmark::pair_sets {

/// A quantity of pairs and the bins it is counted in.
struct PairQuantity {
  std::string name;           ///< "distance (m)"
  std::vector<double> edges;  ///< values beyond the last count in the last bin
  std::function<double(const RegistrationPair&)> value;
};

/// Distance, time offset in frames, symmetric overlap, |roll|, |pitch|, |yaw|: what the paper draws of its sets.
const std::vector<PairQuantity>& pair_quantities();

/// Counts in each bin of the quantity.
std::vector<std::size_t> counts_in_bins(const std::vector<RegistrationPair>& pairs, const PairQuantity& quantity);

/// Pairs, and median / 90th percentile / maximum of distance and |yaw|, 10th percentile / median / 90th of overlap.
text::TextTable set_overview(const std::vector<std::pair<std::string, std::vector<RegistrationPair>>>& sets);

/// Counts by bins of every quantity: the strata of one set.
text::TextTable strata_table(const std::vector<RegistrationPair>& pairs);

/// How uneven the histograms of x, y and yaw are (chi-square over degrees of freedom, 20 bins over the pool's range),
/// for the set and for as many pairs drawn from the pool at random (median of 20 draws).
text::TextTable evenness_table(const std::vector<RegistrationPair>& set, const std::vector<RegistrationPair>& pool,
                               std::uint64_t seed);

/// Chosen and candidates of every drive.
text::TextTable fairness_table(const SelectionReport& report);

/// Unevenness of one column of `motion` (0 x, 1 y, 5 yaw) in bins over the range of the pool.
double motion_unevenness(const std::vector<RegistrationPair>& set, const std::vector<RegistrationPair>& pool, int axis);

}  // namespace loopmark::pair_sets
