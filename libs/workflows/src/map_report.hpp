// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/map_page/map_page.hpp"
#include "loopmark/report/table.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows::internal {

/// The page of a run. `folder` and what `records` refers to must outlive it.
map_page::MapPageInput map_page_input(const map_store::RunFolder& folder, const map_page::MapRecords& records,
                                      const MapSummary& summary, const MapTimes& times);

/// A table of the terminal for the page.
map_page::PageTable page_table(const std::string& title, const report::Table& table);

}  // namespace loopmark::workflows::internal
