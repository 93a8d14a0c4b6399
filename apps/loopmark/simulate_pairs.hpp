// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "loopmark/simulation/pair_sampler.hpp"

namespace loopmark::app {

struct SimulatePairsArguments {
  std::filesystem::path output;
  simulation::TownOptions town;
  std::size_t towns = 1;  ///< so many towns, with seeds from town.seed on; the pairs are shared out between them
  simulation::PairOptions pairs;
};

/// Writes a balanced set of simulated pairs as OUTPUT/pairs.txt, negatives.txt, sessions.txt and one folder of scans
/// a town; whole or not at all. Returns the exit code.
int simulate_pairs(const SimulatePairsArguments& arguments);

}  // namespace loopmark::app
