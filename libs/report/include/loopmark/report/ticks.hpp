// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace loopmark::report {

struct Tick {
  double value = 0.0;
  std::string label;  ///< empty: a mark without a number
};

/// Round numbers (1, 2 or 5 times a power of ten apart) in [low, high], about `wanted` of them.
std::vector<Tick> linear_ticks(double low, double high, std::size_t wanted);

/// Powers of ten in [low, high], both above 0; with their multiples, numbered where there are few powers.
std::vector<Tick> logarithmic_ticks(double low, double high);

}  // namespace loopmark::report
