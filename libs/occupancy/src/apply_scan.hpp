// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "log_odds.hpp"
#include "ray_caster.hpp"
#include "tile_store.hpp"

namespace loopmark::occupancy::internal {

/// Updates the log-odds of every voxel of a scan: once hit, or else once passed.
void apply_scan(const ScanVoxels& voxels, const LogOdds& odds, TileStore& store);

}  // namespace loopmark::occupancy::internal
