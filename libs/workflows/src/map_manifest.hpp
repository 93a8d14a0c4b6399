// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

#include "input_record.hpp"
#include "loopmark/map_export/products.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows::internal {

/// manifest.json of a run of `loopmark map`.
map_export::Manifest manifest_of_map(const MapJob& job, const std::string& started, double seconds,
                                     const InputSummary& input = {});

/// Leaves in the partial run why it ended and with which exit status, if that can still be written.
void leave_manifest(const map_store::RunFolder& folder, map_export::Manifest manifest, const std::exception& problem);

}  // namespace loopmark::workflows::internal
