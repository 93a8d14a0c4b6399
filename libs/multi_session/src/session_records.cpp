// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"
#include "loopmark/map_store/line_text.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/multi_session/session_set.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark::multi_session {
namespace {

std::filesystem::path drives_file(const map_store::RunFolder& run) { return run / "records/sessions.rec"; }

/// The one drive of a run that was made from a log.
SessionRecord only_drive(const map_store::RunFolder& run) {
  SessionRecord drive;
  drive.name = run.name().filename().string();
  std::replace(drive.name.begin(), drive.name.end(), ' ', '_');
  drive.identity = storage::sha256_of_file(run.scan_records());
  drive.scans = map_store::read_scan_records(run).size();
  const std::filesystem::path manifest = run / "manifest.json";
  try {
    drive.log = nlohmann::json::parse(storage::read_file(manifest)).at("input").value("log", "");
  } catch (const nlohmann::json::exception& problem) {
    throw InputError(manifest.string(), "", std::string("is damaged: ") + problem.what());
  }
  return drive;
}

}  // namespace

std::vector<SessionRecord> read_sessions(const map_store::RunFolder& run) {
  std::vector<SessionRecord> drives;
  for (const std::string& text : storage::read_records(drives_file(run)).lines) {
    map_store::LineReader line(text);
    SessionRecord drive;
    drive.first_scan = line.whole();
    drive.scans = line.whole();
    drive.identity = line.word();
    drive.name = line.word();
    drive.log = line.rest();
    drives.push_back(std::move(drive));
  }
  return drives.empty() ? std::vector<SessionRecord>{only_drive(run)} : drives;
}

void write_sessions(const map_store::RunFolder& run, const std::vector<SessionRecord>& drives) {
  std::filesystem::remove(drives_file(run));
  storage::RecordWriter file(drives_file(run));
  for (const SessionRecord& drive : drives) {
    map_store::LineWriter line;
    line.whole(drive.first_scan).whole(drive.scans).word(drive.identity).word(drive.name);
    file.append(line.rest(drive.log).text());
  }
}

void write_records(const SessionSet& set, const map_store::RunFolder& run) {
  write_sessions(run, set.drives);
  std::filesystem::remove(run.scan_records());
  storage::RecordWriter scans(run.scan_records());
  for (const map_store::ScanRecord& scan : set.scans) {
    scans.append(to_line(scan));
  }
  map_store::write_loop_records(run, set.loops);
  map_store::write_loop_decisions(run, set.decisions);
}

}  // namespace loopmark::multi_session
