// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "input_record.hpp"

#include <map>
#include <sstream>

#include "loopmark/storage/files.hpp"

namespace loopmark::workflows::internal {
namespace fs = std::filesystem;
namespace {

fs::path record_file(const map_store::RunFolder& folder) { return folder / "records/inputs.rec"; }

/// "BYTES SHA256 NAME", the name as seen from the log's folder; empty when the file cannot be read.
std::string line_of(const fs::path& file, const fs::path& log) {
  const fs::path base = fs::is_directory(log) ? log : log.parent_path();
  const fs::path name = file.lexically_proximate(base);
  try {
    return std::to_string(fs::file_size(file)) + " " + storage::sha256_of_file(file) + " " + name.string();
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
    : folder_(folder), log_(log), kept_(storage::read_records(record_file(folder)).lines), file_(record_file(folder)) {}

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
    kept_.push_back(line);
  }
}

InputSummary InputRecord::finish() const {
  std::map<std::size_t, std::string> of_scan;  // a scan that a killed run read is read again: the last time counts
  for (const std::string& line : kept_) {
    const std::size_t space = line.find(' ');
    of_scan[std::stoul(line)] = line.substr(space + 1);
  }
  std::vector<std::string> lines;
  for (const fs::path& file : log_.info().companions) {
    lines.push_back(line_of(file, log_.info().path));
  }
  for (const auto& [scan, line] : of_scan) {
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
