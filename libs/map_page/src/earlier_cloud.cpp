// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "earlier_cloud.hpp"

#include <array>

#include "loopmark/core/version.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::map_page::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kEnd = "</script>";
constexpr std::array kNames = {"height_m", "intensity", "cloud", "level_voxels_m",
                               "chunks"};  // what is said of a cloud

Json data_of(const std::string& html) {
  const std::string begin = "id=\"page-data\">";
  const std::size_t at = html.find(begin);
  const std::size_t end = at == std::string::npos ? at : html.find(kEnd, at);
  return end == std::string::npos
             ? Json()
             : Json::parse(html.substr(at + begin.size(), end - at - begin.size()), nullptr, false);
}

bool fits(const Json& data, std::size_t keyframes) {
  if (!data.is_object() || data.value("version", "") != version()) {
    return false;
  }
  for (const char* name : kNames) {
    if (!data.contains(name)) {
      return false;
    }
  }
  std::size_t count = 0;
  for (const Json& chunk : data["chunks"]) {
    count += chunk.value("keyframes", std::size_t{0});
  }
  return count == keyframes;
}

}  // namespace

std::optional<EarlierCloud> earlier_cloud(const std::filesystem::path& page, std::size_t keyframes) {
  if (page.empty() || !std::filesystem::exists(page)) {
    return std::nullopt;
  }
  const std::string html = storage::read_file(page);
  const Json data = data_of(html);
  if (!fits(data, keyframes)) {
    return std::nullopt;
  }
  EarlierCloud cloud;
  for (const char* name : kNames) {
    cloud.json[name] = data.at(name);
  }
  const std::string begin = "<script type=\"text/plain\" class=\"block\" data-name=\"cloud.";
  for (std::size_t at = html.find(begin); at != std::string::npos; at = html.find(begin, at + 1)) {
    cloud.blocks.push_back(html.substr(at, html.find(kEnd, at) - at) + kEnd + "\n");
  }
  return cloud;
}

}  // namespace loopmark::map_page::internal
