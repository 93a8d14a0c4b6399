// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/relocalization_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "loopmark/io/trajectory.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::localization {
namespace {

void write_row(std::ostream& out, const RelocalizedScan& s) {
  out << s.scan << ',' << s.stamp_s << ',' << name(s.state) << ',' << (s.given_up ? 1 : 0) << ',' << s.p_correct << ','
      << (s.answered ? 1 : 0);
  const Eigen::Quaterniond q(s.T_map_lidar.linear());
  const Eigen::Vector3d& t = s.T_map_lidar.translation();
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    out << ',';
    if (s.answered) {
      out << value;
    }
  }
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      out << ',';
      if (s.answered) {
        out << s.covariance(row, column);
      }
    }
  }
  std::string reason = s.reason;
  std::replace(reason.begin(), reason.end(), ',', ';');
  out << ',' << s.inlier_share << ',' << reason << '\n';
}

std::string json_text(const RelocalizationSummary& s) {
  nlohmann::ordered_json json = {{"scans", s.scans},
                                 {"answered", s.answered},
                                 {"first_answer_s", s.first_answer_s},
                                 {"losses", s.losses},
                                 {"recoveries", s.recoveries}};
  if (s.judged > 0) {
    json["judged"] = s.judged;
    json["wrong"] = s.wrong;
    json["median_error_m"] = s.median_error_m;
  }
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
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
    if (scan.given_up) {
      ++summary.losses;
      searching_again = true;
    }
    if (scan.state == RelocalizationState::kTracking && scan.answered && searching_again) {
      ++summary.recoveries;
      searching_again = false;
    }
  }
  return summary;
}

void judge(const std::vector<RelocalizedScan>& scans, const mapping::MapTruth& map, const std::vector<Pose>& true_query,
           RelocalizationSummary& summary) {
  std::vector<double> errors;
  for (const RelocalizedScan& scan : scans) {
    if (!scan.answered || scan.scan >= true_query.size()) {
      continue;
    }
    const PoseError error = map.error(scan.T_map_lidar, true_query[scan.scan]);
    errors.push_back(error.translation_m);
    summary.wrong += is_right(error) ? 0 : 1;
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
  storage::write_file_atomically(folder / "relocalization.csv", [&](std::ostream& out) {
    out.precision(9);
    out << "scan,stamp_s,state,given_up,p_correct,answered,x,y,z,qx,qy,qz,qw";
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        out << ",cov_" << row << column;
      }
    }
    out << ",inlier_share,reason\n";
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
  io::write_tum(folder / "trajectory.tum", stamps, poses);
  storage::write_file_atomically(folder / "summary.json", json_text(summary));
  const nlohmann::ordered_json seconds = {{"whole", summary.seconds}};
  storage::write_file_atomically(folder / "timings.json",
                                 seconds.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace loopmark::localization
