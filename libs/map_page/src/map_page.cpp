// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_page/map_page.hpp"

#include <nlohmann/json.hpp>

#include "answer_columns.hpp"
#include "cloud_chunks.hpp"
#include "columns.hpp"
#include "earlier_cloud.hpp"
#include "evidence_words.hpp"
#include "loopmark/core/version.hpp"
#include "loopmark/mapping/map_components.hpp"
#include "loopmark/web_page/bundle.hpp"

namespace loopmark::map_page {
namespace {

using Json = nlohmann::ordered_json;

const char* word_of(Severity severity) {
  switch (severity) {
    case Severity::kProblem:
      return "problem";
    case Severity::kLook:
      return "look";
    case Severity::kGood:
      break;
  }
  return "good";
}

const char* word_of(LinkKind kind) {
  return kind == LinkKind::kLoop ? "loop" : kind == LinkKind::kAnswer ? "answer" : "scans";
}

Json json_of(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings) {
    Json links = Json::array();
    for (const FindingLink& link : finding.links) {
      links.push_back(
          {{"text", link.text}, {"link", {{"kind", word_of(link.kind)}, {"first", link.first}, {"last", link.last}}}});
    }
    list.push_back({{"severity", word_of(finding.severity)}, {"text", finding.text}, {"links", links}});
  }
  return list;
}

Json json_of(const internal::ChunkedCloud& cloud) {
  Json list = Json::array();
  for (const internal::Chunk& chunk : cloud.chunks) {
    list.push_back({{"name", "cloud." + std::to_string(chunk.first)},
                    {"first", chunk.first},
                    {"keyframes", chunk.keyframes},
                    {"points", chunk.levels.back()},
                    {"levels", chunk.levels},
                    {"scale_m", chunk.scale_m},
                    {"reach_m", chunk.reach_m}});
  }
  return list;
}

Json parts_json(const MapRecords& r, const std::vector<Session>& sessions) {
  Json components = Json::array();
  for (const mapping::MapComponent& part : mapping::map_components(r.scans, r.loops, r.map)) {
    components.push_back({{"name", part.name}, {"scans", part.scans}});
  }
  Json list = Json::array();
  for (const Session& session : sessions) {
    list.push_back({{"name", session.name}, {"first_scan", session.first_scan}, {"scans", session.scans}});
  }
  if (sessions.empty()) {
    list.push_back({{"name", "one"}, {"first_scan", 0}, {"scans", r.scans.size()}});
  }
  return {{"components", components}, {"sessions", list}};
}

Json words_json(const MapRecords& r, const internal::LoopWords& words) {
  Json evidence = Json::array();
  for (const std::string& name : words.evidence) {
    const internal::EvidenceWords said = internal::evidence_words(name);
    evidence.push_back({{"name", name}, {"words", said.words}, {"scale", said.scale}});
  }
  Json problems = Json::object();
  for (const map_store::ScanRecord& scan : r.scans) {
    if (!scan.problem.empty()) {
      problems[std::to_string(scan.scan)] = scan.problem;
    }
  }
  return {{"origins", words.origins.words()},
          {"reasons", words.reasons.words()},
          {"evidence", evidence},
          {"problems", problems}};
}

Json pairs_json(const auto& pairs) {
  Json list = Json::array();
  for (const auto& [name, value] : pairs) {
    list.push_back(Json::array({name, value}));
  }
  return list;
}

Json json_of(const std::vector<PageTable>& tables) {
  Json list = Json::array();
  for (const PageTable& table : tables) {
    list.push_back({{"title", table.title}, {"columns", table.columns}, {"rows", table.rows}});
  }
  return list;
}

std::vector<web_page::Words> words_of(const MapPageInput& input, const std::vector<Finding>& found) {
  std::vector<web_page::Words> words = {{"Map", {input.name}}, {"Findings", {}}};
  for (const auto& [name, value] : input.facts) {
    words.front().lines.push_back(name + ": " + value);
  }
  for (const Finding& finding : found) {
    words.back().lines.push_back(finding.text);
  }
  return words;
}

/// All but what is said of the cloud.
Json solved_json(const MapPageInput& input, const std::vector<Finding>& found, const internal::LoopWords& words) {
  const MapRecords& r = input.records;
  Json json = {{"page", "map"},
               {"title", input.answers ? input.answers->title : "Map"},
               {"name", input.name},
               {"version", version()},
               {"run", input.run},
               {"facts", pairs_json(input.facts)},
               {"note", input.note},
               {"findings", json_of(found)},
               {"min_loop_p", r.min_loop_p},
               {"tables", json_of(input.tables)},
               {"time_parts", pairs_json(input.time_parts)},
               {"edits", {{"possible", input.edits.possible}, {"unsaved", input.edits.unsaved}}}};
  json.update(parts_json(r, input.sessions));
  json.update(words_json(r, words));
  if (input.answers) {
    json["answers"] = internal::answers_json(*input.answers);
  }
  return json;
}

Json cloud_json(const internal::ChunkedCloud& cloud) {
  const auto finest = internal::kLevelVoxel_m.begin() + static_cast<std::ptrdiff_t>(cloud.levels);
  return {{"height_m", cloud.height_m},
          {"intensity", cloud.intensity},
          {"cloud",
           {{"points", cloud.points},
            {"of", cloud.of},
            {"voxel_m", internal::kLevelVoxel_m[cloud.levels - 1]},
            {"rounded_m", internal::kRounded_m}}},
          {"level_voxels_m", std::vector<double>(internal::kLevelVoxel_m.begin(), finest)},
          {"chunks", json_of(cloud)}};
}

/// Of a page with answers these are the matter; what is to be said of its map stands in the map's own page.
std::vector<Finding> findings_of(const MapPageInput& input) {
  return input.answers ? findings(*input.answers) : findings(input.records);
}

/// The cloud of the earlier page where it fits, else made anew; none for a page without a script.
internal::EarlierCloud cloud_of(const MapPageInput& input, const MapPageOptions& options) {
  const mapping::SolvedMap& map = input.records.map;
  if (auto earlier = internal::earlier_cloud(input.earlier_page, map.keyframes.size())) {
    return *earlier;
  }
  internal::ChunkedCloud chunked;
  if (web_page::bundle().problem.empty()) {
    chunked = internal::chunked_cloud(map, input.keyframe_cloud, options.max_points);
  }
  internal::EarlierCloud cloud{cloud_json(chunked), {}};
  for (internal::Chunk& chunk : chunked.chunks) {
    cloud.blocks.push_back(std::move(chunk.blocks));
  }
  return cloud;
}

/// Names of files need not be UTF-8; what is not is replaced.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

web_page::Document map_page(const MapPageInput& input, const MapPageOptions& options) {
  const MapRecords& r = input.records;
  const std::vector<Finding> found = findings_of(input);
  const internal::EarlierCloud cloud = cloud_of(input, options);
  internal::LoopWords words;
  std::string loops = internal::loop_blocks(r, words);
  Json json = solved_json(input, found, words);
  json.update(cloud.json);
  json["licences"] = std::string(web_page::bundle().licences);
  web_page::Document document(input.name, text_of(json), words_of(input, found));
  document.add(internal::scan_blocks(r));
  document.add(internal::keyframe_blocks(r));
  document.add(std::move(loops));
  for (const std::string& block : cloud.blocks) {
    document.add(block);
  }
  if (input.answers) {
    document.add(internal::answer_blocks(*input.answers));
  }
  if (input.edits.possible) {
    document.allow_own_server();
  }
  return document;
}

std::string map_update(const MapPageInput& input, const std::string& message) {
  internal::LoopWords words;
  std::string loops = internal::loop_blocks(input.records, words);
  Json json = solved_json(input, findings_of(input), words);
  json["message"] = message;
  web_page::Document document("", text_of(json), {});
  document.add(internal::scan_blocks(input.records));
  document.add(internal::keyframe_blocks(input.records));
  document.add(std::move(loops));
  return document.data();
}

}  // namespace loopmark::map_page
