// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/drive_writer.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/output_folder.hpp"

namespace loopmark::simulation {
namespace {

/// Scans rendered at a time: enough for every thread, few enough to keep memory small.
constexpr std::size_t kBatch = 8;

std::string revisits_csv(const Drive& drive) {
  std::string text =
      "kind,first_scan,last_scan,earlier_first_scan,earlier_last_scan,length_m,nearest_m,near_identical\n";
  const std::size_t last = drive.size() - 1;
  for (const Revisit& r : drive.revisits()) {
    const auto scan = [&](double distance) { return std::min(last, drive.scan_at(distance)); };
    if (drive.scan_at(r.begin_m) < drive.size()) {
      text += format_text("%s,%zu,%zu,%zu,%zu,%.1f,%.2f,%d\n", name_of(r.kind), scan(r.begin_m), scan(r.end_m),
                          scan(r.earlier_begin_m), scan(r.earlier_end_m), r.length(), r.nearest_m,
                          r.near_identical ? 1 : 0);
    }
  }
  return text;
}

std::string town_json(const Town& town, const Drive& drive, const WriteOptions& write, const WrittenLog& log) {
  const DriveOptions& o = drive.options();
  const SensorModel& s = drive.sensor();
  const Pose T_town_first = drive.pose(drive.stamp_s(0));
  std::string first;
  for (int i = 0; i < 16; ++i) {
    first += format_text(i == 0 ? "%.9f" : ", %.9f", T_town_first.matrix()(i / 4, i % 4));
  }
  constexpr std::array<const char*, 3> kLanes = {"right", "centre", "left"};
  return format_text(
             "{\n  \"town\": {\"seed\": %llu, \"columns\": %d, \"rows\": %d, \"max_slope\": %.3f, \"triangles\": "
             "%zu},\n",
             static_cast<unsigned long long>(town.options.seed), town.options.columns, town.options.rows,
             town.options.max_slope, town.mesh.size()) +
         format_text(
             "  \"drive\": {\"seed\": %llu, \"day\": %d, \"route\": \"%s\", \"lane\": \"%s\", \"reverse\": %s, "
             "\"length_m\": %.2f, \"scans\": %zu, \"points\": %zu},\n",
             static_cast<unsigned long long>(o.seed), o.day, o.route.c_str(), kLanes[static_cast<std::size_t>(o.lane)],
             o.reverse ? "true" : "false", log.length_m, log.scans, log.points) +
         format_text(
             "  \"sensor\": {\"name\": \"%s\", \"label\": \"%s\", \"lasers\": %zu, \"columns\": %d, \"rate_hz\": %.3f, "
             "\"max_range_m\": %.1f, \"height_m\": %.2f},\n",
             s.name.c_str(), s.label.c_str(), s.elevation_rad.size(), s.columns, s.rate_hz, s.max_range_m, s.height_m) +
         "  \"compensated\": " + (write.compensated ? "true" : "false") + ",\n  \"T_town_first\": [" + first + "]\n}\n";
}

std::string sweep_text(const Drive& drive, bool compensated) {
  const double period = 1.0 / drive.sensor().rate_hz;
  return format_text(
      "clockwise seen from above (+z), seam at the rear (azimuth +-180 deg), %.6f s a sweep; scans %s; time of a "
      "point relative to the scan's reference time: -atan2(y, x) / (2 pi) * %.6f s%s\n",
      period, compensated ? "motion compensated to their reference time" : "NOT motion compensated", period,
      compensated ? " before compensation" : "");
}

void write_texts(const Town& town, const Drive& drive, const std::filesystem::path& folder, const WriteOptions& options,
                 const WrittenLog& log) {
  std::string times;
  std::vector<Pose> poses;
  const Pose T_first_town = drive.pose(drive.stamp_s(0)).inverse();
  for (std::size_t i = 0; i < drive.size(); ++i) {
    times += format_text("%.6f\n", drive.stamp_s(i));
    poses.push_back(T_first_town * drive.pose(drive.stamp_s(i)));
  }
  storage::write_file_atomically(folder / "times.txt", times);
  io::write_kitti(folder / "poses.txt", poses);
  const std::string camera = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  storage::write_file_atomically(
      folder / "calib.txt", "P0: " + camera + "P1: " + camera + "P2: " + camera + "P3: " + camera + "Tr: " + camera);
  storage::write_file_atomically(folder / "sweep.txt", sweep_text(drive, options.compensated));
  storage::write_file_atomically(folder / "revisits.csv", revisits_csv(drive));
  storage::write_file_atomically(folder / "town.json", town_json(town, drive, options, log));
}

/// Takes the scans of a drive in order and stores them in the format asked for.
class ScanStore {
 public:
  ScanStore(const std::filesystem::path& folder, const Drive& drive, const WriteOptions& options)
      : folder_(folder / "velodyne"),
        format_(options.format),
        T_first_town_(drive.pose(drive.stamp_s(0)).inverse()),
        drive_(drive) {
    if (format_ == LogFormat::kRawlog) {
      rawlog_ = std::make_unique<mrpt_bridge::RawlogWriter>(folder / "drive.rawlog", drive.sensor().label);
    } else {
      std::filesystem::create_directory(folder_);
    }
  }

  /// Files of their own are written at once, on any thread.
  void store(const Scan& scan) const {
    if (format_ == LogFormat::kPcd) {
      io::write_pcd(folder_ / format_text("%06zu.pcd", scan.index), scan.cloud);
    } else if (format_ == LogFormat::kKitti) {
      io::write_bin(folder_ / format_text("%06zu.bin", scan.index), scan.cloud);
    }
  }

  bool one_file() const { return rawlog_ != nullptr; }
  void append(const Scan& scan) { rawlog_->add(scan, T_first_town_ * drive_.pose(scan.stamp_s)); }

  void finish() {
    if (rawlog_) {
      rawlog_->finish();
    }
  }

 private:
  std::filesystem::path folder_;
  LogFormat format_;
  Pose T_first_town_;
  const Drive& drive_;
  std::unique_ptr<mrpt_bridge::RawlogWriter> rawlog_;
};

Scan make_scan(const World& world, const Drive& drive, std::size_t index, bool compensated) {
  Scan scan = render_scan(world, drive, index, compensated ? Motion::kCompensated : Motion::kRaw);
  if (compensated) {
    scan.cloud.time_offset_s.clear();  // nobody must take them for the points' own moments
  }
  return scan;
}

/// Renders and stores all scans; returns the number of points.
std::size_t write_scans(const World& world, const Drive& drive, const WriteOptions& options, ScanStore& store) {
  std::size_t points = 0;
  Progress progress("simulation", "scans", drive.size());
  for (std::size_t first = 0; first < drive.size(); first += kBatch) {
    check_interrupt();
    std::vector<Scan> batch(std::min(kBatch, drive.size() - first));
    parallel_for(batch.size(), [&](std::size_t k) {
      batch[k] = make_scan(world, drive, first + k, options.compensated);
      store.store(batch[k]);
    });
    for (const Scan& scan : batch) {
      points += scan.cloud.size();
      if (store.one_file()) {
        store.append(scan);
      }
    }
    progress.add(batch.size());
  }
  store.finish();
  return points;
}

}  // namespace

WrittenLog write_drive(const World& world, const Town& town, const Drive& drive, const std::filesystem::path& folder,
                       const WriteOptions& options) {
  storage::OutputFolder output(folder);
  ScanStore store(output.partial(), drive, options);
  WrittenLog log{drive.size(), 0, drive.distance(drive.stamp_s(drive.size() - 1)) - drive.distance(drive.stamp_s(0))};
  log.points = write_scans(world, drive, options, store);
  write_texts(town, drive, output.partial(), options, log);
  output.finish();
  return log;
}

}  // namespace loopmark::simulation
