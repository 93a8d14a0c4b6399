// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows {

/// Maps a log into a new run folder, which remembers what it is made of, so that it can be resumed. Throws InputError
/// when there is no such log, and as run_map does.
MapOutcome start_map(const std::filesystem::path& log, const std::filesystem::path& truth,
                     const std::filesystem::path& run, const std::vector<std::string>& arguments,
                     const ProgramOptions& options);

/// Goes on with a run that was interrupted. `arguments`: of the process that goes on.
MapOutcome resume_map(const std::filesystem::path& run, const std::vector<std::string>& arguments);

/// The log of a run that was interrupted and can be resumed; empty where there is none.
std::filesystem::path log_of_interrupted(const std::filesystem::path& run);

}  // namespace loopmark::workflows
