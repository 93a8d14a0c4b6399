// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command.hpp"
#include "map_run.hpp"

namespace loopmark::app {

/// Maps a log into a new run folder, which remembers what it is made of, so that it can be resumed. Throws InputError
/// when there is no such log, and as run_map does.
MapOutcome start_map(const std::filesystem::path& log, const std::filesystem::path& truth,
                     const std::filesystem::path& run, const Globals& globals, const AppOptions& options);

/// Goes on with a run that was interrupted.
MapOutcome resume_map(const std::filesystem::path& run, const Globals& globals);

}  // namespace loopmark::app
