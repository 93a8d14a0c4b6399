// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_manifest.hpp"

#include "loopmark/core/error.hpp"

namespace loopmark::workflows::internal {

map_export::Manifest manifest_of_map(const MapJob& job, const std::string& started, double seconds,
                                     const InputSummary& input) {
  map_export::Manifest manifest;
  manifest.arguments = job.arguments;
  manifest.resumed = job.resumed;
  manifest.log = job.log.string();
  manifest.input_files = input.files;
  manifest.input_bytes = input.bytes;
  manifest.input_sha256 = input.sha256;
  manifest.started = started;
  manifest.seconds = seconds;
  return manifest;
}

void leave_manifest(const map_store::RunFolder& folder, map_export::Manifest manifest, const std::exception& problem) {
  manifest.exit_status = static_cast<int>(exit_code_of(problem));
  manifest.problem = problem.what();
  try {
    map_export::write_manifest(folder, manifest);
  } catch (const std::exception&) {
    return;  // the first problem is what the user has to know
  }
}

}  // namespace loopmark::workflows::internal
