// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace loopmark::io::internal {

/// The file of a sensor that belongs to a log with packets: one of this kind beside the log, or in it, that bears its
/// name or is called calibration or metadata, else the only one of this kind there. Empty where there is none.
std::filesystem::path find_calibration(const std::filesystem::path& log, const char* extension);

}  // namespace loopmark::io::internal
