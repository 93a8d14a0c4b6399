// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a log says about how its sensor sweeps.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "loopmark/cloud/deskew.hpp"

namespace loopmark::io {

/// What a sweep.txt beside the scans says, in plain words: "clockwise" or "counter-clockwise", "seam at the
/// rear" (front, left, right), "0.1 s a sweep", "not motion compensated".
struct SweepHint {
  std::optional<cloud::SweepModel> model;  ///< set when the direction is said
  std::optional<bool> motion_compensated;  ///< set when it is said
};
SweepHint parse_sweep_hint(const std::string& text);

/// The hint of the file; nothing when there is no such file.
SweepHint read_sweep_hint(const std::filesystem::path& path);

}  // namespace loopmark::io
