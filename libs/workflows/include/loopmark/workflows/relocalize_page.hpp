// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/localization/relocalization_report.hpp"
#include "loopmark/mapping/map_truth.hpp"

namespace loopmark::workflows {

/// report.html in `folder`: the answers on the map of `run`. `truth` may be null; `true_query` has one pose for each
/// scan of the log then.
void write_relocalization_page(const std::filesystem::path& folder, const std::filesystem::path& run,
                               const std::string& log, const std::vector<localization::RelocalizedScan>& scans,
                               const localization::RelocalizationSummary& summary, const mapping::MapTruth* truth,
                               const std::vector<Pose>& true_query);

}  // namespace loopmark::workflows
