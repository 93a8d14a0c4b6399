// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/version.hpp"
#include "loopmark/map_export/products.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::map_export {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFileName = "manifest.json";
constexpr const char* kHow = "SHA-256 of records/inputs.sha256, which has a line of sha256sum for each file read";

nlohmann::ordered_json hashes_of_files(const map_store::RunFolder& folder,
                                       const std::map<std::string, std::string>& known) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder.path())) {
    if (entry.is_regular_file() && entry.path().filename() != kFileName) {
      files.push_back(fs::relative(entry.path(), folder.path()));
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> hashes(files.size());
  parallel_for(files.size(), [&](std::size_t i) {
    const auto found = known.find(files[i].string());
    hashes[i] = found != known.end() ? found->second : storage::sha256_of_file(folder.path() / files[i]);
  });
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < files.size(); ++i) {
    json[files[i].string()] = hashes[i];
  }
  return json;
}

}  // namespace

void write_manifest(const map_store::RunFolder& folder, const Manifest& manifest) {
  nlohmann::ordered_json json;
  json["program"] = std::string("loopmark ") + version();
  json["arguments"] = manifest.arguments;
  if (!manifest.resumed.empty()) {
    json["resumed"] = manifest.resumed;
  }
  json["exit_status"] = manifest.exit_status;
  json["started"] = manifest.started;
  json["seconds"] = manifest.seconds;
  json["input"] = {{"log", manifest.log},
                   {"files", manifest.input_files},
                   {"bytes", manifest.input_bytes},
                   {"sha256", manifest.input_sha256},
                   {"sha256_is", kHow}};
  if (manifest.problem.empty()) {
    json["sha256"] = hashes_of_files(folder, manifest.known_sha256);
  } else {
    json["problem"] = manifest.problem;
  }
  storage::write_file_atomically(folder / kFileName,
                                 json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Manifest input_of_manifest(const map_store::RunFolder& folder) {
  Manifest manifest;
  try {
    const nlohmann::json json = nlohmann::json::parse(storage::read_file(folder / kFileName));
    const nlohmann::json input = json.value("input", nlohmann::json::object());
    manifest.log = input.value("log", "");
    manifest.input_sha256 = input.value("sha256", "");
    manifest.input_files = input.value("files", std::size_t{0});
    manifest.input_bytes = input.value("bytes", std::uint64_t{0});
  } catch (const nlohmann::json::exception& problem) {
    throw InputError((folder / kFileName).string(), "", std::string("is damaged: ") + problem.what());
  }
  return manifest;
}

}  // namespace loopmark::map_export
