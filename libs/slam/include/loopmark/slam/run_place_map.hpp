// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "loopmark/registration/engine_options.hpp"
#include "loopmark/slam/relocalizer.hpp"
#include "loopmark/slam/run_folder.hpp"
#include "loopmark/slam/solved_map.hpp"

namespace loopmark {

/// The map of a run: its keyframes' signatures in memory, their clouds read when they are needed. Poses are those of
/// `solved`; components other than the first are left out, and so are the keyframes whose numbers are `left_out`.
/// Throws InputError when a file of the run is damaged.
std::shared_ptr<const PlaceMap> open_place_map(const RunFolder& run, const SolvedMap& solved,
                                               const RelocalizationOptions& options, const EngineOptions& engine = {},
                                               const std::vector<std::size_t>& left_out = {});

}  // namespace loopmark
