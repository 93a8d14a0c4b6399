// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Whether a map may be trusted as a whole, and if not, why and where.
#pragma once

#include <string>
#include <vector>

#include "loopmark/mapping/solved_map.hpp"

namespace loopmark::mapping {

/// One reason to doubt a map.
struct MapDoubt {
  std::string reason;
  std::vector<std::size_t> scans;  ///< those that it is about, in order
};

/// Everything that speaks against a map; empty: it is good as far as can be told without a reference.
std::vector<MapDoubt> doubts_of(const std::vector<map_store::ScanRecord>& scans,
                                const std::vector<map_store::LoopRecord>& loops, const SolvedMap& map);

/// "good", or "doubtful: " and the reasons with their first scans.
std::string verdict_text(const std::vector<MapDoubt>& doubts);

}  // namespace loopmark::mapping
