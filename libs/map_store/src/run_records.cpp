// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/run_records.hpp"

#include "loopmark/storage/record_file.hpp"

namespace loopmark::map_store {

std::vector<ScanRecord> read_scan_records(const RunFolder& run) {
  std::vector<ScanRecord> records;
  for (const std::string& line : storage::read_records(run.scan_records()).lines) {
    records.push_back(scan_from_line(line));
  }
  return records;
}

std::vector<LoopRecord> read_loop_records(const RunFolder& run) {
  std::vector<LoopRecord> records;
  for (const std::string& line : storage::read_records(run.loop_records()).lines) {
    records.push_back(loop_from_line(line));
  }
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
