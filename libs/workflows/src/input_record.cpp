// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "input_record.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::workflows::internal {
namespace fs = std::filesystem;
namespace {

fs::path record_file(const map_store::RunFolder& folder) { return folder / "records/inputs.rec"; }

/// "BYTES SHA256 NAME", the name as seen from the log's folder; empty when the file cannot be read.
std::string line_of(const fs::path& file, const fs::path& log) {
  const fs::path base = fs::is_directory(log) ? log : log.parent_path();
  std::string name = file.lexically_proximate(base).string();
  std::replace(name.begin(), name.end(), '\n', '?');  // a record is a line
  try {
    return std::to_string(fs::file_size(file)) + " " + storage::sha256_of_file(file) + " " + name;
  } catch (const std::exception&) {
    return "";  // reading the scan says so: it is damaged
  }
}

struct Line {
  std::uint64_t bytes = 0;
  std::string sha256_and_name;  ///< as sha256sum writes it
};

Line parsed(const std::string& text) {
  std::istringstream words(text);
  Line line;
  std::string sha256;
  words >> line.bytes >> sha256;
  std::string name;
  std::getline(words >> std::ws, name);
  line.sha256_and_name = sha256 + "  " + name + "\n";
  return line;
}

}  // namespace

InputRecord::InputRecord(const map_store::RunFolder& folder, const io::DriveLog& log)
    : folder_(folder), log_(log), file_(record_file(folder)) {
  std::size_t number = 0;
  for (const std::string& line : storage::read_records(record_file(folder)).lines) {
    take(line, ++number);
  }
}

/// A line of the record file: "SCAN BYTES SHA256 NAME".
void InputRecord::take(const std::string& line, std::size_t number) {
  std::size_t scan = 0;
  const char* const end = line.data() + line.size();
  const auto [stop, error] = std::from_chars(line.data(), end, scan);
  if (error != std::errc() || stop == end || *stop != ' ' || scan >= log_.size()) {
    throw InputError(record_file(folder_).string(), "line " + std::to_string(number), "tells of no scan of the log",
                     "delete the file: its hashes are made again");
  }
  kept_[scan] = std::string(stop + 1, end);
}

void InputRecord::verify(std::size_t scans) {
  std::vector<std::string> now(std::min(scans, log_.size()));
  parallel_for(now.size(), [&](std::size_t i) { now[i] = of_scan(i); });
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto kept = kept_.find(i);
    if (kept == kept_.end()) {
      keep(now[i]);
    } else if (now[i] != std::to_string(i) + " " + kept->second) {
      throw InputError(
          log_.scan_file(i).string(), "",
          "is not what it was when the run was interrupted (SHA-256 in " + record_file(folder_).string() + ")",
          "bring the file back, or map the log anew");
    }
  }
}

std::string InputRecord::of_scan(std::size_t index) const {
  const fs::path file = log_.scan_file(index);
  if (file.empty() || (index > 0 && log_.scan_file(index - 1) == file)) {
    return "";
  }
  const std::string line = line_of(file, log_.info().path);
  return line.empty() ? "" : std::to_string(index) + " " + line;
}

void InputRecord::keep(const std::string& line) {
  if (!line.empty()) {
    file_.append(line);
    take(line, 0);
  }
}

InputSummary InputRecord::finish() const {
  std::vector<std::string> lines;
  for (const fs::path& file : log_.info().companions) {
    lines.push_back(line_of(file, log_.info().path));
  }
  for (const auto& [scan, line] : kept_) {
    lines.push_back(line);
  }
  InputSummary summary;
  std::string text;
  for (const std::string& line : lines) {
    if (!line.empty()) {
      const Line file = parsed(line);
      ++summary.files;
      summary.bytes += file.bytes;
      text += file.sha256_and_name;
    }
  }
  summary.sha256 = storage::sha256_hex(text);
  storage::write_file_atomically(folder_ / "records/inputs.sha256", text);
  return summary;
}

}  // namespace loopmark::workflows::internal
