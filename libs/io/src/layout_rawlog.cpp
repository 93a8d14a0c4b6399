// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "layout_parts.hpp"
#include "layouts.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"
#include "loopmark/text/text.hpp"
#include "point_columns.hpp"

namespace loopmark::io::internal {
namespace fs = std::filesystem;
namespace {

bool is_rawlog(const fs::path& path) {
  const std::string extension = text::lower_case(path.extension().string());
  std::error_code error;
  return extension == ".rawlog" && fs::is_regular_file(path, error);
}

/// The file itself, or the only rawlog of a folder.
fs::path find_rawlog(const fs::path& path) {
  if (is_rawlog(path)) {
    return path;
  }
  fs::path found;
  std::error_code error;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    if (!is_rawlog(it->path())) {
      continue;
    }
    if (!found.empty()) {
      throw InputError(path.string(), "", "several rawlogs in this folder", "name one of the files");
    }
    found = it->path();
  }
  return found;
}

class RawlogLog : public DriveLog {
 public:
  RawlogLog(const fs::path& file, const LogOptions& options) : reader_(file, options.sensor_label), options_(options) {
    FileLogParts parts;
    parts.files.resize(reader_.size());
    for (std::size_t i = 0; i < reader_.size(); ++i) {
      parts.stamps_s.push_back(reader_.stamp_s(i));
    }
    const std::string times_problem = repair_timestamps(parts.stamps_s, file);
    if (!reader_.truth().poses.empty()) {
      take_truth_interpolated(parts, reader_.truth().stamps_s, reader_.truth().poses, file.string());
    }
    truth_ = std::move(parts.truth);
    stamps_s_ = std::move(parts.stamps_s);
    info_ = std::move(parts.info);
    info_.problem = times_problem;
    info_.format = "rawlog";
    info_.path = file;
    info_.stamps_given = true;
    info_.stamps_source = "rawlog, sensor '" + reader_.sensor_label() + "'";
    if (!reader_.problem().empty()) {
      info_.problem = reader_.problem();
      log(Severity::kWarning, file.string() + ": " + info_.problem + "; the scans before are used");
    }
  }

  std::size_t size() const override { return reader_.size(); }
  double stamp_s(std::size_t index) const override { return stamps_s_.at(index); }
  std::string scan_name(std::size_t index) const override { return info_.path.string() + ":" + reader_.place(index); }
  fs::path scan_file(std::size_t) const override { return info_.path; }
  Scan read(std::size_t index) const override { return read_closely(index).scan; }
  const LogInfo& info() const override { return info_; }
  std::vector<Pose> truth() const override { return truth_; }

  ScanReading read_closely(std::size_t index) const override {
    PointCloud cloud;
    try {
      cloud = reader_.read(index);
    } catch (const DamagedScan&) {
      throw;
    } catch (const InputError& error) {
      throw DamagedScan(error.what());
    }
    ScanReading reading{{index, stamp_s(index), {}}, {}, false, false};
    reading.scan.cloud = filter_invalid(std::move(cloud), options_, reading.dropped);
    finish_reading(reading, scan_name(index), info_, options_);
    return reading;
  }

 private:
  mrpt_bridge::RawlogReader reader_;
  LogOptions options_;
  LogInfo info_;
  std::vector<double> stamps_s_;
  std::vector<Pose> truth_;
};

}  // namespace

LogPointer open_rawlog(const fs::path& path, const LogOptions& options) {
  const fs::path file = find_rawlog(path);
  return file.empty() ? nullptr : std::make_unique<RawlogLog>(file, options);
}

}  // namespace loopmark::io::internal
