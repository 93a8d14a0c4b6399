// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <nlohmann/json.hpp>

#include "line_text.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/core/record_file.hpp"
#include "loopmark/slam/drive_set.hpp"
#include "loopmark/slam/run_records.hpp"

namespace loopmark {
namespace {

std::filesystem::path drives_file(const RunFolder& run) { return run / "records/drives.rec"; }

/// The one drive of a run that was made from a log.
DriveRecord only_drive(const RunFolder& run) {
  DriveRecord drive;
  drive.name = run.name().filename().string();
  std::replace(drive.name.begin(), drive.name.end(), ' ', '_');
  drive.identity = sha256_of_file(run.scan_records());
  drive.scans = read_scan_records(run).size();
  const std::filesystem::path manifest = run / "manifest.json";
  try {
    drive.log = nlohmann::json::parse(read_file(manifest)).at("input").value("log", "");
  } catch (const nlohmann::json::exception& problem) {
    throw InputError(manifest.string(), "", std::string("is damaged: ") + problem.what());
  }
  return drive;
}

}  // namespace

std::vector<DriveRecord> read_drives(const RunFolder& run) {
  std::vector<DriveRecord> drives;
  for (const std::string& text : read_records(drives_file(run)).lines) {
    LineReader line(text);
    DriveRecord drive;
    drive.first_scan = line.whole();
    drive.scans = line.whole();
    drive.identity = line.word();
    drive.name = line.word();
    drive.log = line.rest();
    drives.push_back(std::move(drive));
  }
  return drives.empty() ? std::vector<DriveRecord>{only_drive(run)} : drives;
}

void write_drives(const RunFolder& run, const std::vector<DriveRecord>& drives) {
  std::filesystem::remove(drives_file(run));
  RecordWriter file(drives_file(run));
  for (const DriveRecord& drive : drives) {
    LineWriter line;
    line.whole(drive.first_scan).whole(drive.scans).word(drive.identity).word(drive.name);
    file.append(line.rest(drive.log).text());
  }
}

void write_records(const DriveSet& set, const RunFolder& run) {
  write_drives(run, set.drives);
  std::filesystem::remove(run.scan_records());
  RecordWriter scans(run.scan_records());
  for (const ScanRecord& scan : set.scans) {
    scans.append(to_line(scan));
  }
  write_loop_records(run, set.loops);
  write_loop_decisions(run, set.decisions);
}

}  // namespace loopmark
