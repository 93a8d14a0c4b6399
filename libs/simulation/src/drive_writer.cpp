// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/drive_writer.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "loopmark/core/files.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/simulation/output_folder.hpp"

namespace loopmark::simulation {
namespace {

/// Scans rendered at a time: enough for every thread, few enough to keep memory small.
constexpr std::size_t kBatch = 8;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string revisits_csv(const Drive& drive) {
  std::string text = "kind,first_scan,last_scan,earlier_first_scan,earlier_last_scan,length_m,nearest_m,near_identical\n";
  const std::size_t last = drive.size() - 1;
  for (const Revisit& r : drive.revisits()) {
    const auto scan = [&](double distance) { return std::min(last, drive.scan_at(distance)); };
    if (drive.scan_at(r.begin_m) < drive.size()) {
      text += format("%s,%zu,%zu,%zu,%zu,%.1f,%.2f,%d\n", name_of(r.kind), scan(r.begin_m), scan(r.end_m),
                     scan(r.earlier_begin_m), scan(r.earlier_end_m), r.length(), r.nearest_m, r.near_identical ? 1 : 0);
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
    first += format(i == 0 ? "%.9f" : ", %.9f", T_town_first.matrix()(i / 4, i % 4));
  }
  constexpr std::array<const char*, 3> kLanes = {"right", "centre", "left"};
  return format("{\n  \"town\": {\"seed\": %llu, \"columns\": %d, \"rows\": %d, \"max_slope\": %.3f, \"triangles\": %zu},\n",
                static_cast<unsigned long long>(town.options.seed), town.options.columns, town.options.rows,
                town.options.max_slope, town.mesh.size()) +
         format("  \"drive\": {\"seed\": %llu, \"day\": %d, \"route\": \"%s\", \"lane\": \"%s\", \"reverse\": %s, "
                "\"length_m\": %.2f, \"scans\": %zu, \"points\": %zu},\n",
                static_cast<unsigned long long>(o.seed), o.day, o.route.c_str(),
                kLanes[static_cast<std::size_t>(o.lane)], o.reverse ? "true" : "false", log.length_m, log.scans, log.points) +
         format("  \"sensor\": {\"name\": \"%s\", \"label\": \"%s\", \"lasers\": %zu, \"columns\": %d, \"rate_hz\": %.3f, "
                "\"max_range_m\": %.1f, \"height_m\": %.2f},\n",
                s.name.c_str(), s.label.c_str(), s.elevation_rad.size(), s.columns, s.rate_hz, s.max_range_m, s.height_m) +
         "  \"compensated\": " + (write.compensated ? "true" : "false") + ",\n  \"T_town_first\": [" + first + "]\n}\n";
}

std::string sweep_text(const Drive& drive, bool compensated) {
  const double period = 1.0 / drive.sensor().rate_hz;
  return format("clockwise seen from above (+z), seam at the rear (azimuth +-180 deg), %.6f s a sweep; scans %s; time of a "
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
    times += format("%.6f\n", drive.stamp_s(i));
    poses.push_back(T_first_town * drive.pose(drive.stamp_s(i)));
  }
  write_file_atomically(folder / "times.txt", times);
  write_kitti(folder / "poses.txt", poses);
  const std::string camera = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  write_file_atomically(folder / "calib.txt", "P0: " + camera + "P1: " + camera + "P2: " + camera + "P3: " + camera + "Tr: " + camera);
  write_file_atomically(folder / "sweep.txt", sweep_text(drive, options.compensated));
  write_file_atomically(folder / "revisits.csv", revisits_csv(drive));
  write_file_atomically(folder / "town.json", town_json(town, drive, options, log));
}

}  // namespace

WrittenLog write_drive(const World& world, const Town& town, const Drive& drive, const std::filesystem::path& folder,
                       const WriteOptions& options) {
  OutputFolder output(folder);
  const std::filesystem::path scans = output.partial() / "velodyne";
  std::filesystem::create_directory(scans);
  const bool pcd = options.format == LogFormat::kPcd;
  const Motion frame = options.compensated ? Motion::kCompensated : Motion::kRaw;
  WrittenLog log{drive.size(), 0, drive.distance(drive.stamp_s(drive.size() - 1)) - drive.distance(drive.stamp_s(0))};
  Progress progress("scans", drive.size());
  for (std::size_t first = 0; first < drive.size(); first += kBatch) {
    check_interrupt();
    const std::size_t count = std::min(kBatch, drive.size() - first);
    std::vector<std::size_t> points(count);
    parallel_for(count, [&](std::size_t k) {
      Scan scan = render_scan(world, drive, first + k, frame);
      if (options.compensated) {
        scan.cloud.time_offset_s.clear();  // nobody must take them for the points' own moments
      }
      const std::filesystem::path file = scans / format(pcd ? "%06zu.pcd" : "%06zu.bin", first + k);
      pcd ? write_pcd(file, scan.cloud) : write_bin(file, scan.cloud);
      points[k] = scan.cloud.size();
    });
    for (const std::size_t n : points) {
      log.points += n;
    }
    progress.add(count);
  }
  write_texts(town, drive, output.partial(), options, log);
  output.finish();
  return log;
}

}  // namespace loopmark::simulation
