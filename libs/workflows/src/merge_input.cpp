// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"
#include "loopmark/core/version.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/merge_run.hpp"
#include "loopmark/workflows/opened_run.hpp"

namespace loopmark::workflows {
namespace fs = std::filesystem;
namespace {

/// "loopmark 0.1" of "loopmark 0.1.3": versions that read each other's runs.
std::string generation(const std::string& program) { return program.substr(0, program.rfind('.')); }

void require_this_version(const map_store::RunFolder& run) {
  const fs::path manifest = run / "manifest.json";
  std::string program;
  try {
    program = nlohmann::json::parse(storage::read_file(manifest)).value("program", "an unknown program");
  } catch (const nlohmann::json::exception& problem) {
    throw InputError(manifest.string(), "", std::string("is damaged: ") + problem.what());
  }
  const std::string own = std::string("loopmark ") + version();
  if (generation(program) != generation(own)) {
    throw InputError(run.name().string(), "", "was made by " + program + ", this is " + own,
                     "map its log again with this version");
  }
}

}  // namespace

std::vector<Pose> poses_of(const multi_session::SessionRecord& drive, const std::vector<Pose>& poses) {
  if (poses.empty()) {
    return {};
  }
  const auto begin = poses.begin() + static_cast<std::ptrdiff_t>(drive.first_scan);
  return {begin, begin + static_cast<std::ptrdiff_t>(drive.scans)};
}

MergeInput read_runs(const std::vector<fs::path>& runs) {
  MergeInput input{runs, {}, {}};
  for (const fs::path& path : runs) {
    const map_store::RunFolder run = map_store::RunFolder::open(path);
    require_this_version(run);
    multi_session::SessionSet set = multi_session::read_session_set(run);
    const std::vector<Pose> truth = truth_of(run, set.scans.size());
    for (const multi_session::SessionRecord& drive : set.drives) {
      input.truth.push_back(poses_of(drive, truth));
    }
    append(std::move(set), input.set);
  }
  return input;
}

}  // namespace loopmark::workflows
