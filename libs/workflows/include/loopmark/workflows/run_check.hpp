// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Whether all that a whole run should hold is there, as it was written.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "loopmark/map_store/run_folder.hpp"

namespace loopmark::workflows {

/// From what a file of a run can be made again, to the same bytes.
enum class MadeFrom {
  kNothing,  ///< records, clouds, prepared scans (of the whole scans), reports that tell times
  kCloud,    ///< keyframes/NUMBER.place, from the .pcd beside it
  kRecords   ///< trajectories, maps, scenes: from records and clouds
};
MadeFrom made_from(const std::string& file);

struct RunFault {
  std::string file;  ///< path in the run
  std::string problem;
};

struct RunCheck {
  std::size_t files = 0;         ///< that the manifest names
  std::uint64_t bytes = 0;       ///< of those whose sum was taken
  std::vector<RunFault> faults;  ///< in the order of their names; empty: the run is sound
};

/// The SHA-256 of each file, as manifest.json has them. Throws InputError when it is damaged or names a file outside.
std::map<std::string, std::string> sums_of_manifest(const map_store::RunFolder& run);

/// Looks at the structure of the records and at every file that the manifest names; `sums`: takes their SHA-256, too.
RunCheck check_run(const map_store::RunFolder& run, bool sums);

/// Makes the place signature of a keyframe again.
void make_place_again(const map_store::RunFolder& run, std::size_t keyframe);

/// Makes files of a run again that can be made from its records and clouds; one whose bytes do not come out as the
/// manifest has them stays as it is. The names of those that were made. Throws InputError when the records or clouds
/// are not sound.
std::vector<std::string> repair_run(const map_store::RunFolder& run, const std::vector<RunFault>& faults);

}  // namespace loopmark::workflows
