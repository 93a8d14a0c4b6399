// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What every stage of mapping made of one pair of keyframes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "loopmark/localization/place_rank.hpp"
#include "loopmark/workflows/opened_run.hpp"

namespace loopmark::workflows {

struct Verifier {
  KeyframePair pair;
  std::optional<localization::PlaceRank> place;   ///< nothing: the target was passed just before
  bool looked_up = false;                         ///< places were looked up for the source keyframe
  std::optional<std::size_t> loop;                ///< the pair's record among the run's loops, when it was a candidate
  registration::RegistrationResult registration;  ///< made now, from what the run keeps of both keyframes
};

/// Goes through the stages again. Throws InputError when a file of the run is missing or damaged.
Verifier inquire(const OpenedRun& run, const mapping::SolvedMap& map, const KeyframePair& pair);

/// The stages in words, the verdict last.
std::string inquiry_text(const OpenedRun& run, const mapping::SolvedMap& map, const Verifier& inquiry);

/// The two keyframes before and after the motion that registration found: a PNG.
void write_inquiry_picture(const OpenedRun& run, const Verifier& inquiry, const std::filesystem::path& path);

}  // namespace loopmark::workflows
