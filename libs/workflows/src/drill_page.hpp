// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "loopmark/map_page/map_page.hpp"
#include "loopmark/workflows/drill_run.hpp"

namespace loopmark::workflows::internal {

/// report.html in `folder`: what became of each event, on the map of `run`. `facts`, `note` and `tables` as in
/// map_page::MapPageInput.
void write_drill_page(const std::filesystem::path& folder, const std::filesystem::path& run, const DrillResult& result,
                      const std::vector<std::pair<std::string, std::string>>& facts, const std::string& note,
                      const std::vector<map_page::PageTable>& tables);

}  // namespace loopmark::workflows::internal
