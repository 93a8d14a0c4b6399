// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "loopmark/localization/relocalizer.hpp"
#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/registration/engine_options.hpp"

namespace loopmark::localization {

/// The map of a run: its keyframes' descriptors in memory, their clouds read when they are needed. Poses are those of
/// `solved`; components other than the first are left out, and so are the keyframes whose numbers are `left_out`.
/// Throws InputError when a file of the run is damaged.
std::shared_ptr<const PlaceMap> open_place_map(const map_store::RunFolder& run, const mapping::SolvedMap& solved,
                                               const RelocalizationOptions& options,
                                               const registration::EngineOptions& engine = {},
                                               const std::vector<std::size_t>& left_out = {});

}  // namespace loopmark::localization
