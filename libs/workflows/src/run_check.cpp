// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/run_check.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/multi_session/session_set.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::workflows {
namespace fs = std::filesystem;
namespace {

bool is_inside(const fs::path& name) {
  return name.is_relative() &&
         std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

/// What is wrong with a file; empty where nothing is.
std::string problem_of(const fs::path& file, const std::string& sum, bool sums) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return "is missing";
  }
  try {
    return sums && storage::sha256_of_file(file) != sum ? "is not as it was written (SHA-256)" : "";
  } catch (const InputError& unreadable) {
    return unreadable.what();
  }
}

/// Records that cannot be believed, whatever their sums say.
void check_structure(const map_store::RunFolder& run, const std::map<std::string, std::string>& sums, RunCheck& check) {
  try {
    const multi_session::SessionSet set = multi_session::read_session_set(run);
    for (std::size_t k = 0; k < set.keyframe_files.size(); ++k) {
      const std::string cloud = fs::path(run.keyframe(k, "pcd")).lexically_relative(run.path()).string();
      if (sums.count(cloud) == 0) {
        check.faults.push_back({cloud, "is not in the manifest"});
      }
    }
  } catch (const InputError& error) {
    check.faults.push_back({"records", error.what()});
  }
}

}  // namespace

MadeFrom made_from(const std::string& file) {
  const fs::path path(file);
  const std::string ending = path.extension().string();
  if (path.parent_path() == "keyframes") {
    return ending == ".place" ? MadeFrom::kCloud : MadeFrom::kNothing;
  }
  const auto is = [&ending](std::initializer_list<const char*> endings) {
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
  };
  const bool product = is({".tum", ".kitti", ".csv", ".g2o", ".bt", ".ot", ".ply", ".simplemap", ".3Dscene"});
  return !path.has_parent_path() && product ? MadeFrom::kRecords : MadeFrom::kNothing;
}

std::map<std::string, std::string> sums_of_manifest(const map_store::RunFolder& run) {
  const fs::path file = run / "manifest.json";
  std::map<std::string, std::string> sums;
  try {
    const nlohmann::json manifest = nlohmann::json::parse(storage::read_file(file));
    for (const auto& [name, sum] : manifest.at("sha256").items()) {
      if (!is_inside(name)) {
        throw InputError(file.string(), "", "names the file '" + name + "' outside the run", "copy the run again");
      }
      sums[name] = sum.get<std::string>();
    }
  } catch (const nlohmann::json::exception& problem) {
    throw InputError(file.string(), "", std::string("is damaged: ") + problem.what(), "copy the run again");
  }
  return sums;
}

RunCheck check_run(const map_store::RunFolder& run, bool sums) {
  const std::map<std::string, std::string> expected = sums_of_manifest(run);
  const std::vector<std::pair<std::string, std::string>> files(expected.begin(), expected.end());
  std::vector<std::string> problems(files.size());
  parallel_for(files.size(),
               [&](std::size_t i) { problems[i] = problem_of(run.path() / files[i].first, files[i].second, sums); });
  RunCheck check;
  check.files = files.size();
  check_structure(run, expected, check);
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::error_code missing;
    const auto bytes = fs::file_size(run.path() / files[i].first, missing);
    check.bytes += missing ? 0 : bytes;
    if (!problems[i].empty()) {
      check.faults.push_back({files[i].first, problems[i]});
    }
  }
  return check;
}

void make_place_again(const map_store::RunFolder& run, std::size_t keyframe) {
  map_store::write_keyframe_place(run, keyframe, map_store::read_keyframe_cloud(run, keyframe));
}

}  // namespace loopmark::workflows
