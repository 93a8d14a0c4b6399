// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pool_records.hpp"

#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/number_rows.hpp"

namespace loopmark::pair_sets::internal {
namespace {

using Json = nlohmann::json;

/// Text that is the same for the same pool.
std::string identity(const std::vector<Drive>& drives, std::size_t spacing, const BalanceOptions& options) {
  std::string poses;
  for (const Drive& drive : drives) {
    for (std::size_t i = 0; i < drive.size(); ++i) {
      poses += std::to_string(drive.frames[i]) + ' ' + format_text("%f", drive.stamps_s[i]);
      text::append_motion(poses, drive.T_world_cloud[i]);
    }
    poses += "session " + std::to_string(drive.session) + '\n';
  }
  const Json json = {{"pool", storage::sha256_hex(poses)}, {"spacing", spacing},
                     {"min_overlap", options.min_overlap}, {"symmetric", options.symmetric},
                     {"max_gap_s", options.max_gap_s},     {"seed", options.seed}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Json to_json(const RegistrationPair& pair) {
  Json json = {pair.key.session,        pair.key.source, pair.key.target,
               pair.key.target_session, pair.overlap,    pair.overlap_symmetric};
  for (int i = 0; i < 12; ++i) {
    json.push_back(pair.T_target_source.matrix()(i / 4, i % 4));
  }
  return json;
}

RegistrationPair from_json(const Json& json) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < 12; ++i) {
    pose.matrix()(i / 4, i % 4) = json.at(static_cast<std::size_t>(6 + i)).get<double>();
  }
  return make_pair({json.at(0), json.at(1), json.at(2), json.at(3)}, pose, json.at(4), json.at(5));
}

}  // namespace

PoolRecords::PoolRecords(const std::filesystem::path& path, const std::vector<Drive>& drives, std::size_t spacing,
                         const BalanceOptions& options) {
  if (path.empty()) {
    return;
  }
  const std::string own = identity(drives, spacing, options);
  const std::vector<std::string> lines = storage::read_records(path).lines;
  if (!lines.empty() && lines.front() != own) {
    throw InputError(path.string(), "", "candidates of other drives or options", "delete it, or give another -o");
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    try {
      const Json json = Json::parse(lines[i]);
      auto& pairs = found_[json.at("block").get<std::size_t>()];
      pairs.clear();
      for (const Json& pair : json.at("pairs")) {
        pairs.push_back(from_json(pair));
      }
    } catch (const Json::exception& problem) {
      throw InputError(path.string(), "line " + std::to_string(i + 1), std::string("is no block: ") + problem.what(),
                       "delete it: its pairs are looked for again");
    }
  }
  writer_ = std::make_unique<storage::RecordWriter>(path);
  if (lines.empty()) {
    writer_->append(own);
  }
}

const std::vector<RegistrationPair>* PoolRecords::find(std::size_t block) const {
  const auto found = found_.find(block);
  return found == found_.end() ? nullptr : &found->second;
}

void PoolRecords::add(std::size_t block, const std::vector<RegistrationPair>& pairs) {
  if (!writer_) {
    return;
  }
  Json json = {{"block", block}, {"pairs", Json::array()}};
  for (const RegistrationPair& pair : pairs) {
    json["pairs"].push_back(to_json(pair));
  }
  writer_->append(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace loopmark::pair_sets::internal
