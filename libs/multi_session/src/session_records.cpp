// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "loopmark/core/error.hpp"
#include "loopmark/map_store/line_text.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/multi_session/session_set.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark::multi_session {
namespace {

std::filesystem::path drives_file(const map_store::RunFolder& run) { return run / "records/sessions.rec"; }

/// The name that the file had before.
std::filesystem::path older_file(const map_store::RunFolder& run) { return run / "records/drives.rec"; }

/// Sessions follow each other, hold all scans and share no segment; their names differ and name no folder. Throws
/// InputError with the line.
void require_sound(const std::vector<SessionRecord>& drives, const std::vector<map_store::ScanRecord>& scans,
                   const std::filesystem::path& file) {
  std::size_t line = 0;
  const auto require = [&](bool good, const std::string& problem) {
    if (!good) {
      throw InputError(file.string(), "line " + std::to_string(line), problem,
                       "the run was changed or damaged: copy it again, or merge again");
    }
  };
  std::set<std::string> names;
  std::size_t next = 0;
  for (const SessionRecord& drive : drives) {
    ++line;
    require(drive.first_scan == next && drive.scans > 0 && drive.scans <= scans.size() - next,
            "scans " + std::to_string(drive.first_scan) + " and " + std::to_string(drive.scans) +
                " more: " + std::to_string(next) + " is due, and the run has " + std::to_string(scans.size()));
    require(next == 0 || scans[next].segment != scans[next - 1].segment, "shares a segment with the session before it");
    require(drive.name.find('/') == std::string::npos && names.insert(drive.name).second,
            "the name of the session is taken, or that of a folder");
    next += drive.scans;
  }
  ++line;
  require(next == scans.size(),
          "scans " + std::to_string(next) + " to " + std::to_string(scans.size()) + " belong to no session");
}

/// The one drive of a run that was made from a log.
SessionRecord only_drive(const map_store::RunFolder& run, std::size_t scans) {
  SessionRecord drive;
  drive.name = run.name().filename().string();
  std::replace(drive.name.begin(), drive.name.end(), ' ', '_');
  drive.identity = storage::sha256_of_file(run.scan_records());
  drive.scans = scans;
  const std::filesystem::path manifest = run / "manifest.json";
  try {
    drive.log = nlohmann::json::parse(storage::read_file(manifest)).at("input").value("log", "");
  } catch (const nlohmann::json::exception& problem) {
    throw InputError(manifest.string(), "", std::string("is damaged: ") + problem.what());
  }
  return drive;
}

}  // namespace

std::vector<SessionRecord> read_sessions(const map_store::RunFolder& run,
                                         const std::vector<map_store::ScanRecord>& scans) {
  const std::filesystem::path file = std::filesystem::exists(older_file(run)) ? older_file(run) : drives_file(run);
  std::vector<SessionRecord> drives;
  for (const std::string& text : storage::read_records(file).lines) {
    map_store::LineReader line(text);
    SessionRecord drive;
    drive.first_scan = line.whole();
    drive.scans = line.whole();
    drive.identity = line.word();
    drive.name = line.word();
    drive.log = line.rest();
    drives.push_back(std::move(drive));
  }
  if (drives.empty()) {
    return {only_drive(run, scans.size())};
  }
  require_sound(drives, scans, file);
  return drives;
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
