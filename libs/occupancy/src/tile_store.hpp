// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/storage/spill_store.hpp"
#include "tile.hpp"

namespace loopmark::occupancy::internal {

/// All tiles of a map by tile_number; a round is a scan, a tile weighs its blocks.
using TileStore = storage::SpillStore<std::uint32_t, Tile>;

}  // namespace loopmark::occupancy::internal
