// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/map_job.hpp"

#include <nlohmann/json.hpp>

#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/printable.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::workflows {
namespace {

std::filesystem::path job_file(const map_store::RunFolder& folder) { return folder / "records/job.json"; }

void write_job(const map_store::RunFolder& folder, const MapJob& job, const ProgramOptions& options) {
  nlohmann::ordered_json json = {
      {"log", job.log.string()}, {"truth", job.truth.string()}, {"arguments", job.arguments}, {"resumed", job.resumed}};
  for (const auto& [name, path] : {std::pair("log", job.log.string()), std::pair("truth", job.truth.string())}) {
    if (!is_utf8(path)) {
      json[name + std::string("_bytes")] = hex_of(path);  // JSON holds UTF-8 only
    }
  }
  storage::write_file_atomically(folder / "config.yaml", options_as_yaml(options));
  storage::write_file_atomically(job_file(folder),
                                 json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  storage::sync_folder(job_file(folder).parent_path());
  storage::sync_folder(folder.path());
}

MapJob read_job(const map_store::RunFolder& folder) {
  try {
    const nlohmann::json json = nlohmann::json::parse(storage::read_file(job_file(folder)));
    const auto path = [&json](const std::string& name) {
      return json.contains(name + "_bytes") ? bytes_of_hex(json.at(name + "_bytes").get<std::string>())
                                            : json.at(name).get<std::string>();
    };
    return {path("log"), path("truth"), json.value("arguments", std::vector<std::string>{}),
            json.value("resumed", std::vector<std::vector<std::string>>{})};
  } catch (const nlohmann::json::exception& problem) {
    throw InputError(job_file(folder).string(), "", std::string("is damaged: ") + problem.what(),
                     "delete the folder and map the log anew");
  }
}

}  // namespace

MapOutcome start_map(const std::filesystem::path& log, const std::filesystem::path& truth,
                     const std::filesystem::path& run, const std::vector<std::string>& arguments,
                     const ProgramOptions& options) {
  if (!std::filesystem::exists(log)) {
    throw InputError(log.string(), "", "there is no such log", "give a folder of scans or a rawlog");
  }
  const MapJob job{std::filesystem::absolute(log), truth.empty() ? truth : std::filesystem::absolute(truth), arguments};
  const map_store::RunFolder folder = map_store::RunFolder::create(run);
  try {
    write_job(folder, job, options);
    return run_map(folder, job, options);
  } catch (...) {
    if (!std::filesystem::exists(folder.scan_records())) {  // there is nothing yet that could be resumed
      std::error_code ignored;
      std::filesystem::remove_all(folder.path(), ignored);
    }
    throw;
  }
}

MapOutcome resume_map(const std::filesystem::path& run, const std::vector<std::string>& arguments) {
  const map_store::RunFolder folder = map_store::RunFolder::resume(run);
  const ProgramOptions options = config::load<ProgramOptions>(folder / "config.yaml", {});
  MapJob job = read_job(folder);
  job.resumed.push_back(arguments);
  write_job(folder, job, options);
  return run_map(folder, job, options);
}

std::filesystem::path log_of_interrupted(const std::filesystem::path& run) {
  const std::filesystem::path partial = run.string() + ".partial";
  return std::filesystem::exists(partial / "records/job.json") ? read_job(map_store::RunFolder::resume(run)).log
                                                               : std::filesystem::path();
}

}  // namespace loopmark::workflows
