// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace loopmark::map_page::internal {

/// The cloud of a page that was written before: what is said of it, and its blocks as they are.
struct EarlierCloud {
  nlohmann::ordered_json json;
  std::vector<std::string> blocks;
};

/// Points stand in the frames of their keyframes, so that a run solved anew can show them as they are: no keyframe is
/// read again. Nothing where there is no such page, or where it was made by another version, without a cloud, or of
/// other than `keyframes` keyframes.
std::optional<EarlierCloud> earlier_cloud(const std::filesystem::path& page, std::size_t keyframes);

}  // namespace loopmark::map_page::internal
