// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <set>

#include "loopmark/core/number_text.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/map_export/products.hpp"
#include "loopmark/mapping/map_components.hpp"
#include "loopmark/pose_graph/g2o.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::map_export {
namespace {

std::string number(double value) { return format_text("%.9g", value); }

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    result += c == '"' ? "\"\"" : std::string(1, c);
  }
  return result + "\"";
}

std::string covariances_csv(const std::vector<map_store::ScanRecord>& scans, const mapping::SolvedMap& map) {
  static constexpr const char* kAxes[] = {"x", "y", "z", "rx", "ry", "rz"};
  std::string text = "scan,stamp_s,component,state,tracking,inlier_share,residual_m,degenerate_directions";
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      text += std::string(",cov_") + kAxes[row] + "_" + kAxes[column];
    }
  }
  text += ",doubt\n";
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::string stamp = format_text("%.6f", scans[i].stamp_s);
    text += std::to_string(scans[i].scan) + "," + stamp + "," + std::to_string(map.component[i]) + "," +
            name(scans[i].state) + "," + name(scans[i].tracking) + "," + number(scans[i].inlier_share) + "," +
            number(scans[i].residual_m) + "," + std::to_string(scans[i].degenerate);
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        text += "," + number(map.covariance[i](row, column));
      }
    }
    text += "," + quoted(scans[i].problem) + "\n";
  }
  return text;
}

/// All evidence names that occur, in alphabetical order.
std::set<std::string> evidence_names(const std::vector<map_store::LoopRecord>& loops) {
  std::set<std::string> names;
  for (const map_store::LoopRecord& loop : loops) {
    for (const auto& [word, value] : loop.evidence) {
      names.insert(word);
    }
  }
  return names;
}

std::string loops_csv(const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map) {
  const std::set<std::string> names = evidence_names(loops);
  std::string text =
      "source_scan,target_scan,source_keyframe,target_keyframe,origin,accepted,reason,p_correct,"
      "x,y,z,roll_deg,pitch_deg,yaw_deg,weight,chi2";
  for (const std::string& evidence : names) {
    text += "," + evidence;
  }
  text += "\n";
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const map_store::LoopRecord& loop = loops[i];
    const Eigen::Vector3d t = loop.T_target_source.translation();
    const Eigen::Vector3d rpy = euler_degrees(loop.T_target_source.linear());
    text += std::to_string(map.keyframes[loop.source].scan) + "," + std::to_string(map.keyframes[loop.target].scan) +
            "," + std::to_string(loop.source) + "," + std::to_string(loop.target) + "," + loop.origin + "," +
            (map.loops[i].accepted ? "1" : "0") + "," + quoted(map.loops[i].reason) + "," + number(loop.p_correct);
    for (const double value :
         {t.x(), t.y(), t.z(), rpy.x(), rpy.y(), rpy.z(), map.loops[i].weight, map.loops[i].chi2}) {
      text += "," + number(value);
    }
    for (const std::string& evidence : names) {
      text += ",";
      for (const auto& [word, value] : loop.evidence) {
        text += word == evidence ? number(value) : "";
      }
    }
    text += "\n";
  }
  return text;
}

std::string components_csv(const std::vector<mapping::MapComponent>& components) {
  std::string text =
      "name,anchored,scans,first_scan,last_scan,begin_s,end_s,segments,keyframes,path_m,candidates_to_others,best_p,"
      "best\n";
  for (const mapping::MapComponent& c : components) {
    const std::string stamps = format_text("%.6f,%.6f", c.begin_s, c.end_s);
    text += c.name + "," + (c.anchored ? "1" : "0") + "," + std::to_string(c.scans) + "," +
            std::to_string(c.first_scan) + "," + std::to_string(c.last_scan) + "," + stamps + "," +
            std::to_string(c.segments) + "," + std::to_string(c.keyframes) + "," + number(c.path_m) + "," +
            std::to_string(c.candidates) + "," + number(c.best_p) + "," + quoted(c.best) + "\n";
  }
  return text;
}

/// Says in front of a trajectory which of its poses have no place in the map.
std::string apart_comment(const std::vector<mapping::MapComponent>& components) {
  std::string text;
  for (std::size_t c = 1; c < components.size(); ++c) {
    text += "# " + components[c].name + ": " + std::to_string(components[c].scans) + " scans, " +
            std::to_string(components[c].first_scan) + " to " + std::to_string(components[c].last_scan) +
            ", have no place in the map; their poses are in a frame of their own\n";
  }
  return text;
}

void write_trajectories(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                        const mapping::SolvedMap& map, const std::vector<mapping::MapComponent>& components) {
  std::vector<double> stamps_s;
  for (const map_store::ScanRecord& scan : scans) {
    stamps_s.push_back(scan.stamp_s);
  }
  storage::write_file_atomically(folder / "trajectory.tum",
                                 apart_comment(components) + io::tum_text(stamps_s, map.T_map_scan));
  io::write_kitti(folder / "trajectory.kitti", map.T_map_scan);
  for (std::size_t c = 1; c < components.size(); ++c) {
    std::vector<double> stamps;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (map.component[i] == c) {
        stamps.push_back(scans[i].stamp_s);
        poses.push_back(map.T_map_scan[i]);
      }
    }
    io::write_tum(folder / (components[c].name + ".tum"), stamps, poses);
  }
}

}  // namespace

void write_trajectory_products(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                               const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map) {
  const std::vector<mapping::MapComponent> components = mapping::map_components(scans, loops, map);
  write_trajectories(folder, scans, map, components);
  storage::write_file_atomically(folder / "components.csv", components_csv(components));
  storage::write_file_atomically(folder / "covariances.csv", covariances_csv(scans, map));
  storage::write_file_atomically(folder / "loops.csv", loops_csv(loops, map));
  pose_graph::PoseGraph graph = map.graph;
  graph.T_map_node = map.T_map_keyframe;
  pose_graph::write_g2o(folder / "pose_graph.g2o", graph);
}

}  // namespace loopmark::map_export
