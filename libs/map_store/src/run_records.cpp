// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/run_records.hpp"

#include "loopmark/core/error.hpp"
#include "loopmark/map_store/record_rules.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark::map_store {

namespace {

template <class Record>
std::vector<Record> read_all(const std::filesystem::path& file, Record (*parse)(const std::string&)) {
  std::vector<Record> records;
  for (const std::string& line : storage::read_records(file).lines) {
    try {
      records.push_back(parse(line));
    } catch (const InputError& error) {
      throw InputError(file.string(), "line " + std::to_string(records.size() + 1), error.what());
    }
  }
  return records;
}

}  // namespace

RunRecords read_run_records(const RunFolder& run) {
  RunRecords records;
  records.scans = read_all(run.scan_records(), scan_from_line);
  require_sound(records.scans, run.scan_records());
  const std::size_t keyframes = keyframes_in(records.scans);
  records.loops = read_all(run.loop_records(), loop_from_line);
  require_sound(records.loops, keyframes, run.loop_records());
  records.decisions = read_loop_decisions(run);
  require_sound(records.decisions, keyframes, decisions_file(run));
  return records;
}

void write_loop_records(const RunFolder& run, const std::vector<LoopRecord>& records) {
  std::filesystem::remove(run.loop_records());
  storage::RecordWriter file(run.loop_records());
  for (const LoopRecord& record : records) {
    file.append(to_line(record));
  }
}

}  // namespace loopmark::map_store
