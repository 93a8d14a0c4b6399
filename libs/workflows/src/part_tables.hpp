// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The components and the drives of a run, as tables and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "loopmark/report/table.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows::internal {

report::Table component_table(const std::vector<mapping::MapComponent>& components);
report::Table drive_table(const std::vector<DriveSummary>& drives);
report::Table inter_session_table(const std::vector<InterSessionSummary>& inter_session_loops);

nlohmann::ordered_json components_json(const std::vector<mapping::MapComponent>& components);
nlohmann::ordered_json drives_json(const std::vector<DriveSummary>& drives);
nlohmann::ordered_json inter_session_json(const std::vector<InterSessionSummary>& inter_session_loops);

/// "1", or "2 without a common frame: main (812 scans, 0-811, 702.1 m), component_1 (90 scans, 812-901, 41.0 m)".
std::string components_text(const std::vector<mapping::MapComponent>& components);

}  // namespace loopmark::workflows::internal
