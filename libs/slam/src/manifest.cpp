// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <nlohmann/json.hpp>

#include "loopmark/core/files.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/version.hpp"
#include "loopmark/slam/products.hpp"

namespace loopmark {
namespace fs = std::filesystem;

void write_manifest(const RunFolder& folder, const Manifest& manifest) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder.path())) {
    if (entry.is_regular_file() && entry.path().filename() != "manifest.json") {
      files.push_back(fs::relative(entry.path(), folder.path()));
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> hashes(files.size());
  parallel_for(files.size(), [&](std::size_t i) {
    const auto known = manifest.known_sha256.find(files[i].string());
    hashes[i] = known != manifest.known_sha256.end() ? known->second : sha256_of_file(folder.path() / files[i]);
  });
  nlohmann::ordered_json json;
  json["program"] = std::string("loopmark ") + version();
  json["arguments"] = manifest.arguments;
  json["exit_status"] = manifest.exit_status;
  json["started"] = manifest.started;
  json["seconds"] = manifest.seconds;
  json["input"] = {{"log", manifest.log}, {"sha256_of_scans_as_read", manifest.input_sha256}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    json["sha256"][files[i].string()] = hashes[i];
  }
  write_file_atomically(folder / "manifest.json", json.dump(1) + "\n");
}

}  // namespace loopmark
