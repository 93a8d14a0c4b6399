// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/simulation/drive_writer.hpp"
#include "loopmark/simulation/pair_sampler.hpp"

namespace loopmark::simulation {

/// All that `loopmark simulate` can be told.
struct SimulationOptions {
  TownOptions town;
  DriveOptions drive;
  WriteOptions write;
  PairOptions pairs;
};

template <class Visitor>
void describe(Visitor& v, SimulationOptions& o) {
  v.section("town", o.town, "streets and what stands along them");
  v.section("drive", o.drive, "one drive through the town");
  v.section("write", o.write, "how a drive is written");
  v.section("pairs", o.pairs, "pairs of scans with exact motions");
}

}  // namespace loopmark::simulation
