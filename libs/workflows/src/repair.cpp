// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/run_check.hpp"

#include <algorithm>

#include "loopmark/core/error.hpp"
#include "loopmark/map_store/run_in_making.hpp"
#include "loopmark/multi_session/session_set.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/map_run.hpp"
#include "loopmark/workflows/opened_run.hpp"

namespace loopmark::workflows {
namespace fs = std::filesystem;
namespace {

using Sums = std::map<std::string, std::string>;

/// Gives `made` the name of the file in the run when it has the bytes that it should have.
bool put_in_place(const fs::path& made, const std::string& file, const map_store::RunFolder& run, const Sums& sums) {
  std::error_code missing;
  if (!fs::exists(made, missing) || storage::sha256_of_file(made) != sums.at(file)) {
    return false;
  }
  fs::rename(made, run / file);
  return true;
}

std::vector<std::string> places_again(const map_store::RunFolder& run, const map_store::RunFolder& fresh,
                                      const std::vector<RunFault>& faults, std::size_t keyframes, const Sums& sums) {
  std::vector<std::string> made;
  for (std::size_t k = 0; k < keyframes; ++k) {
    const std::string file = fs::path(run.keyframe(k, "place")).lexically_relative(run.path()).string();
    const auto is_file = [&file](const RunFault& fault) { return fault.file == file; };
    if (std::any_of(faults.begin(), faults.end(), is_file)) {
      make_place_again(fresh, k);
      if (put_in_place(fresh.keyframe(k, "place"), file, run, sums)) {
        made.push_back(file);
      }
    }
  }
  return made;
}

}  // namespace

std::vector<std::string> repair_run(const map_store::RunFolder& run, const std::vector<RunFault>& faults) {
  const workflows::OpenedRun opened = workflows::open_run(run.path(), {});
  const multi_session::SessionSet set = multi_session::read_session_set(run);
  const Sums sums = sums_of_manifest(run);
  const map_store::RunInMaking fresh(map_store::RunFolder::revise(run.path()));
  for (std::size_t k = 0; k < set.keyframe_files.size(); ++k) {
    fs::create_hard_link(run.keyframe(k, "pcd"), fresh.folder().keyframe(k, "pcd"));
  }
  std::vector<std::string> made = places_again(run, fresh.folder(), faults, set.keyframe_files.size(), sums);
  const auto is_product = [](const RunFault& fault) { return made_from(fault.file) == MadeFrom::kRecords; };
  if (std::any_of(faults.begin(), faults.end(), is_product)) {
    const mapping::SolvedMap map = mapping::solve_map(opened.scans, opened.loops, opened.options.slam,
                                                      opened.options.pose_graph, opened.decisions);
    workflows::write_maps(fresh.folder(), opened.scans, opened.loops, map, opened.options);
    for (const RunFault& fault : faults) {
      if (is_product(fault) && put_in_place(fresh.folder() / fault.file, fault.file, run, sums)) {
        made.push_back(fault.file);
      }
    }
  }
  storage::sync_file_system(run.path());
  return made;
}

}  // namespace loopmark::workflows
