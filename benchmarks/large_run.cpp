// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// large_run RUN METRES OUT: a run folder of the size that a drive of so many metres leaves, made without one, to
// measure what works on records: loopmark loops OUT --veto I-J. Two laps of a hilly circuit, ten scans a second at 10
// m/s, a keyframe every 2.5 m, two loop candidates every 5 m of the second lap with the noise that registration has,
// every tenth of them wrong. The keyframes' files are links to the first one of RUN, whose options and evidence are
// taken over.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "loopmark/core/random.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/record_file.hpp"

namespace {

namespace fs = std::filesystem;
using namespace loopmark;

constexpr double kStep = 1.0;              // metres a scan
constexpr std::size_t kKeyframeEvery = 3;  // scans

loopmark::Vector6d noise(loopmark::Rng& rng, double metres, double degrees) {
  loopmark::Vector6d xi;
  for (int axis = 0; axis < 6; ++axis) {
    xi[axis] = rng.normal() * (axis < 3 ? metres : degrees * M_PI / 180.0);
  }
  return xi;
}

loopmark::Pose on_circuit(double at_m, double lap_m) {
  const double radius = lap_m / (2.0 * M_PI);
  const double angle = at_m / radius;
  return loopmark::pose_from_yaw(angle + M_PI / 2.0,
                                 {radius * std::cos(angle), radius * std::sin(angle), 5.0 * std::sin(3.0 * angle)});
}

class LargeRun {
 public:
  LargeRun(const fs::path& model, double metres, const fs::path& out)
      : model_(map_store::RunFolder::open(model)), metres_(metres), folder_(map_store::RunFolder::create(out)) {}

  void write() {
    write_scans();
    write_loops();
    for (const char* file : {"config.yaml", "summary.json", "timings.json", "manifest.json"}) {
      fs::copy_file(model_ / file, folder_ / file);
    }
    folder_.finish();
    std::printf("%s: %zu scans, %zu keyframes, %zu loop candidates\n", folder_.path().c_str(), truth_.size(),
                scan_of_keyframe_.size(), loops_);
  }

 private:
  void write_scans() {
    storage::RecordWriter file(folder_.scan_records());
    std::vector<double> stamps;
    loopmark::Pose T_segment_lidar = loopmark::Pose::Identity();
    for (double at = 0.0; at < metres_; at += kStep) {
      map_store::ScanRecord record;
      record.scan = truth_.size();
      record.stamp_s = 0.1 * static_cast<double>(record.scan);
      record.state = record.scan == 0 ? map_store::ScanState::kNewSegment : map_store::ScanState::kTracked;
      truth_.push_back(on_circuit(at, metres_ / 2.0));
      if (record.scan > 0) {
        T_segment_lidar = T_segment_lidar * truth_[record.scan - 1].inverse() * truth_.back() *
                          loopmark::exp_se3(noise(rng_, 0.01, 0.02));
      }
      record.T_segment_lidar = T_segment_lidar;
      record.inlier_share = 0.9;
      record.residual_m = 0.05;
      record.covariance = 1e-5 * loopmark::Matrix6d::Identity();
      if (record.scan % kKeyframeEvery == 0) {
        record.keyframe = scan_of_keyframe_.size();
        scan_of_keyframe_.push_back(record.scan);
        for (const char* ending : {"pcd", "place", "prepared"}) {
          fs::create_hard_link(model_.keyframe(0, ending), folder_.keyframe(*record.keyframe, ending));
        }
      }
      file.append(to_line(record));
      stamps.push_back(record.stamp_s);
    }
    io::write_tum(folder_ / "records/truth.tum", stamps, truth_);
    io::write_tum(folder_ / "trajectory.tum", stamps, truth_);
  }

  void write_loops() {
    storage::RecordWriter file(folder_.loop_records());
    const std::vector<map_store::LoopRecord> known = map_store::read_run_records(model_).loops;
    const std::size_t lap = scan_of_keyframe_.size() / 2;
    for (std::size_t k = lap; k < scan_of_keyframe_.size(); k += 2) {
      for (const std::size_t shift : {0U, 3U}) {
        map_store::LoopRecord loop;
        loop.source = k;
        loop.target = std::min(k - lap + shift, lap - 1);
        loop.origin = "place";
        loop.answered = loops_ % 4 != 3;
        loop.p_correct = loop.answered ? 0.97 : 0.2;
        loop.reason = loop.answered ? "" : "the evidence is weak";
        const bool wrong = loops_ % 10 == 9;
        loop.T_target_source = (wrong ? loopmark::pose_from_yaw(1.0, {6.0, -4.0, 0.0})
                                      : loopmark::Pose(loopmark::exp_se3(noise(rng_, 0.1, 0.1)))) *
                               truth_[scan_of_keyframe_[loop.target]].inverse() * truth_[scan_of_keyframe_[k]];
        loop.covariance = 1e-4 * loopmark::Matrix6d::Identity();
        loop.evidence = known.empty() ? registration::Evidence{} : known.front().evidence;
        file.append(to_line(loop));
        ++loops_;
      }
    }
  }

  map_store::RunFolder model_;
  double metres_;
  map_store::RunFolder folder_;
  loopmark::Rng rng_{1};
  std::vector<loopmark::Pose> truth_;
  std::vector<std::size_t> scan_of_keyframe_;
  std::size_t loops_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: large_run RUN METRES OUT\n");
    return 2;
  }
  try {
    LargeRun(argv[1], std::stod(argv[2]), argv[3]).write();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  return EXIT_SUCCESS;
}
