// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/relocalization_report.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

#include "loopmark/core/files.hpp"
#include "loopmark/io/trajectory.hpp"

namespace loopmark {
namespace {

constexpr double kRightM = 0.6;
constexpr double kRightDeg = 5.0;

std::size_t nearest_scan(const std::vector<Pose>& true_map, const Pose& query) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < true_map.size(); ++i) {
    const double squared = (true_map[i].translation() - query.translation()).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = i;
    }
  }
  return nearest;
}

void write_row(std::ostream& out, const RelocalizedScan& s) {
  out << s.scan << ',' << s.stamp_s << ',' << name(s.state) << ',' << s.p_correct << ',' << (s.answered ? 1 : 0);
  const Eigen::Quaterniond q(s.T_map_lidar.linear());
  const Eigen::Vector3d& t = s.T_map_lidar.translation();
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    out << ',';
    if (s.answered) {
      out << value;
    }
  }
  for (int i = 0; i < 6; ++i) {
    out << ',';
    if (s.answered) {
      out << s.covariance(i, i);
    }
  }
  std::string reason = s.reason;
  std::replace(reason.begin(), reason.end(), ',', ';');
  out << ',' << s.inlier_share << ',' << reason << '\n';
}

std::string json_text(const RelocalizationSummary& s) {
  nlohmann::ordered_json json = {
      {"scans", s.scans},   {"answered", s.answered},     {"first_answer_s", s.first_answer_s},
      {"losses", s.losses}, {"recoveries", s.recoveries}, {"seconds", s.seconds}};
  if (s.judged > 0) {
    json["judged"] = s.judged;
    json["wrong"] = s.wrong;
    json["median_error_m"] = s.median_error_m;
  }
  return json.dump(1) + "\n";
}

}  // namespace

RelocalizationSummary summarize(const std::vector<RelocalizedScan>& scans) {
  RelocalizationSummary summary;
  summary.scans = scans.size();
  bool searching_again = false;
  for (const RelocalizedScan& scan : scans) {
    if (scan.answered && summary.answered++ == 0) {
      summary.first_answer_s = scan.stamp_s - scans.front().stamp_s;
    }
    if (scan.state == RelocalizationState::kLost) {
      ++summary.losses;
      searching_again = true;
    } else if (scan.state == RelocalizationState::kTracking && searching_again) {
      ++summary.recoveries;
      searching_again = false;
    }
  }
  return summary;
}

void judge(const std::vector<RelocalizedScan>& scans, const std::vector<Pose>& T_map_scan,
           const std::vector<Pose>& true_map, const std::vector<Pose>& true_query, RelocalizationSummary& summary) {
  if (T_map_scan.size() != true_map.size() || true_map.empty()) {
    throw std::invalid_argument("the map's truth needs one pose for each of its scans");
  }
  std::vector<double> errors;
  for (const RelocalizedScan& scan : scans) {
    if (!scan.answered || scan.scan >= true_query.size()) {
      continue;
    }
    const Pose& truth = true_query[scan.scan];
    const std::size_t near = nearest_scan(true_map, truth);
    const PoseError error = pose_error(T_map_scan[near].inverse() * scan.T_map_lidar, true_map[near].inverse() * truth);
    errors.push_back(error.translation_m);
    summary.wrong += error.translation_m > kRightM || error.rotation_deg > kRightDeg ? 1 : 0;
  }
  summary.judged = errors.size();
  if (!errors.empty()) {
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    summary.median_error_m = *middle;
  }
}

void write_relocalization(const std::filesystem::path& folder, const std::vector<RelocalizedScan>& scans,
                          const RelocalizationSummary& summary) {
  write_file_atomically(folder / "relocalization.csv", [&](std::ostream& out) {
    out.precision(9);
    out << "scan,stamp_s,state,p_correct,answered,x,y,z,qx,qy,qz,qw,var_x,var_y,var_z,var_roll,var_pitch,var_yaw,"
           "inlier_share,reason\n";
    for (const RelocalizedScan& scan : scans) {
      write_row(out, scan);
    }
  });
  std::vector<double> stamps;
  std::vector<Pose> poses;
  for (const RelocalizedScan& scan : scans) {
    if (scan.answered) {
      stamps.push_back(scan.stamp_s);
      poses.push_back(scan.T_map_lidar);
    }
  }
  write_tum(folder / "trajectory.tum", stamps, poses);
  write_file_atomically(folder / "summary.json", json_text(summary));
}

}  // namespace loopmark
