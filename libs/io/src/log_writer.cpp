// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/log_writer.hpp"

#include <cmath>

#include "folder_log_writer.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/recorded_log.hpp"
#include "recording_log_writer.hpp"

namespace loopmark::io {
namespace {

/// The scans of a log, written one after the other as the observations between them come.
class ScanFeed {
 public:
  ScanFeed(const DriveLog& log, LogWriter& writer, const ConvertOptions& options)
      : log_(log), writer_(writer), options_(options), truth_(log.truth()), progress_("scans", log.size()) {}

  bool within(double stamp_s) const {
    const double since = stamp_s - log_.stamp_s(0);
    return since >= options_.from_s && since <= options_.to_s;
  }

  /// Writes all scans that are not written yet up to this stamp.
  void write_until(double stamp_s) {
    for (; next_ < log_.size() && log_.stamp_s(next_) <= stamp_s; ++next_) {
      check_interrupt();
      progress_.add();
      if (next_ % options_.every == 0 && within(log_.stamp_s(next_))) {
        write_one(next_);
      }
    }
  }

  ConvertedLog result;

 private:
  void write_one(std::size_t index) {
    constexpr std::size_t kMostProblems = 5;
    try {
      const Scan scan = log_.read(index);
      writer_.add(scan, truth_.empty() ? std::nullopt : std::optional(truth_[index]));
      ++result.scans;
    } catch (const DamagedScan& damage) {
      ++result.damaged;
      if (result.problems.size() < kMostProblems) {
        result.problems.emplace_back(damage.what());
      }
    }
  }

  const DriveLog& log_;
  LogWriter& writer_;
  ConvertOptions options_;
  std::vector<Pose> truth_;
  Progress progress_;
  std::size_t next_ = 0;
};

}  // namespace

const std::vector<std::string>& log_writer_formats() {
  static const std::vector<std::string> formats = {"kitti", "pcd", "mcap", "rosbag1", "rosbag2"};
  return formats;
}

std::unique_ptr<LogWriter> create_log_writer(const std::string& format, const std::filesystem::path& path) {
  using messages::Encoding;
  if (format == "kitti" || format == "pcd") {
    return std::make_unique<internal::FolderLogWriter>(path, format == "pcd");
  }
  if (format == "mcap") {
    return std::make_unique<internal::RecordingLogWriter>(recordings::create_mcap(path), recordings::Encoding::kCdr);
  }
  if (format == "rosbag1") {
    return std::make_unique<internal::RecordingLogWriter>(recordings::create_rosbag(path), recordings::Encoding::kRos1);
  }
  if (format == "rosbag2") {
    return std::make_unique<internal::RecordingLogWriter>(recordings::create_rosbag2(path), recordings::Encoding::kCdr);
  }
  throw InputError("no format '" + format + "' to write: there are kitti, pcd, mcap, rosbag1, rosbag2");
}

ConvertedLog convert_log(const DriveLog& log, LogWriter& writer, const ConvertOptions& options) {
  require_option(options.every >= 1, "every", "must be at least 1");
  if (log.size() == 0) {
    throw InputError(log.info().path.string(), "", "no scans");
  }
  const RecordedLog* recorded = as_recorded(log);
  if (recorded != nullptr) {
    writer.add_mounts(recorded->recording().mounts);
  }
  ScanFeed feed(log, writer, options);
  const ObservationVisitor take = [&](const Observation& observation) {
    const double stamp = std::visit([](const auto& o) { return o.source.stamp_s; }, observation);
    if (!feed.within(stamp)) {
      return;
    }
    feed.write_until(stamp);
    writer.add(observation);
    ++feed.result.observations;
  };
  if (recorded != nullptr) {
    recorded->visit_observations(take);
  }
  feed.write_until(log.stamp_s(log.size() - 1));
  if (feed.result.scans == 0) {
    throw InputError(log.info().path.string(), "", "no scan could be written",
                     feed.result.problems.empty() ? "look at --from and --to" : feed.result.problems.front());
  }
  writer.finish();
  return feed.result;
}

}  // namespace loopmark::io
