// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pose_graph/g2o.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <map>
#include <sstream>

#include "loopmark/core/error.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::pose_graph {
namespace {

/// d(xi on the left of Z) / d(g2o's error on the right): rotation vector = 2 * vector part of the quaternion.
Matrix6d left_from_g2o(const Pose& T_from_to) {
  Vector6d scale;
  scale << 1.0, 1.0, 1.0, 2.0, 2.0, 2.0;
  return adjoint(T_from_to) * scale.asDiagonal();
}

void write_pose(std::ostream& out, const Pose& pose) {
  Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  if (q.w() < 0.0) {
    q.coeffs() *= -1.0;
  }
  const Eigen::Vector3d& t = pose.translation();
  out << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w();
}

void write_edge(std::ostream& out, const PoseGraphEdge& edge) {
  if (edge.kind != EdgeKind::kOdometry) {
    out << (edge.kind == EdgeKind::kLoop ? "# loop\n" : "# forced\n");
  } else if (edge.to != edge.from + 1) {
    out << "# odometry\n";
  }
  const Matrix6d to_left = left_from_g2o(edge.T_from_to);
  const Matrix6d information = to_left.transpose() * edge.information * to_left;
  out << "EDGE_SE3:QUAT " << edge.from << ' ' << edge.to;
  write_pose(out, edge.T_from_to);
  for (int r = 0; r < 6; ++r) {
    for (int c = r; c < 6; ++c) {
      out << ' ' << 0.5 * (information(r, c) + information(c, r));
    }
  }
  out << '\n';
}

/// Reads one file line by line; every problem names the line.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path) {}

  PoseGraph read() {
    std::istringstream content(storage::read_file(path_));
    std::string line;
    while (std::getline(content, line)) {
      ++line_;
      read_line(line);
    }
    return finished();
  }

 private:
  struct NamedEdge {
    long from, to;
    PoseGraphEdge edge;
    std::string kind;
    std::size_t line;
  };

  [[noreturn]] void fail(const std::string& problem, std::size_t line) const {
    throw InputError(path_.string(), std::to_string(line), problem, "expected a 3-D pose graph as g2o writes it");
  }

  double number(std::istringstream& words) const {
    std::string word;
    words >> word;
    const std::optional<double> value = number_in(word);
    if (!value || !std::isfinite(*value)) {
      fail(word.empty() ? "the line ends too early" : "\"" + word + "\" is no finite number", line_);
    }
    return *value;
  }

  long id(std::istringstream& words) const {
    const double value = number(words);
    if (value < 0.0 || value > 1e15 || value != std::floor(value)) {
      fail("a vertex id must be a whole number from 0", line_);
    }
    return static_cast<long>(value);
  }

  Pose pose(std::istringstream& words) const {
    double v[7];
    for (double& x : v) {
      x = number(words);
    }
    const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (std::abs(q.norm() - 1.0) > 1e-2) {
      fail("the quaternion does not have length 1", line_);
    }
    Pose T = Pose::Identity();
    T.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
    T.linear() = q.normalized().toRotationMatrix();
    return T;
  }

  void read_line(const std::string& line) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    if (tag.empty()) {
      return;
    }
    if (tag[0] == '#') {
      words >> kind_;
    } else if (tag == "VERTEX_SE3:QUAT") {
      const long vertex = id(words);
      if (!vertices_.emplace(vertex, pose(words)).second) {
        fail("vertex " + std::to_string(vertex) + " is there twice", line_);
      }
    } else if (tag == "EDGE_SE3:QUAT") {
      read_edge(words);
    } else if (tag == "FIX") {
      fixed_.push_back(id(words));
    } else {
      fail("unknown tag \"" + tag + "\"", line_);
    }
  }

  void read_edge(std::istringstream& words) {
    NamedEdge named{id(words), id(words), {}, kind_, line_};
    kind_.clear();
    named.edge.T_from_to = pose(words);
    Matrix6d information;
    for (int r = 0; r < 6; ++r) {
      for (int c = r; c < 6; ++c) {
        information(r, c) = information(c, r) = number(words);
      }
    }
    const Matrix6d to_g2o = left_from_g2o(named.edge.T_from_to).inverse();
    named.edge.information = to_g2o.transpose() * information * to_g2o;
    edges_.push_back(named);
  }

  std::size_t index_of(long vertex, std::size_t line) const {
    const auto found = index_.find(vertex);
    if (found == index_.end()) {
      fail("there is no vertex " + std::to_string(vertex), line);
    }
    return found->second;
  }

  static EdgeKind kind_of(const NamedEdge& named) {
    if (named.kind == "loop" || named.kind == "forced") {
      return named.kind == "loop" ? EdgeKind::kLoop : EdgeKind::kForced;
    }
    const bool consecutive = std::abs(named.from - named.to) == 1;
    return named.kind == "odometry" || consecutive ? EdgeKind::kOdometry : EdgeKind::kLoop;
  }

  PoseGraph finished() {
    PoseGraph graph;
    for (const auto& [vertex, T_map_node] : vertices_) {
      index_[vertex] = graph.T_map_node.size();
      graph.T_map_node.push_back(T_map_node);
    }
    for (NamedEdge& named : edges_) {
      named.edge.from = index_of(named.from, named.line);
      named.edge.to = index_of(named.to, named.line);
      named.edge.kind = kind_of(named);
      graph.edges.push_back(named.edge);
    }
    for (const long vertex : fixed_) {
      graph.anchors.push_back(index_of(vertex, line_));
    }
    return graph;
  }

  std::filesystem::path path_;
  std::size_t line_ = 0;
  std::string kind_;
  std::map<long, Pose> vertices_;
  std::map<long, std::size_t> index_;
  std::vector<NamedEdge> edges_;
  std::vector<long> fixed_;
};

}  // namespace

void write_g2o(const std::filesystem::path& path, const PoseGraph& graph) {
  storage::write_file_atomically(path, [&](std::ostream& out) {
    out << std::setprecision(17);
    for (std::size_t node = 0; node < graph.T_map_node.size(); ++node) {
      out << "VERTEX_SE3:QUAT " << node;
      write_pose(out, graph.T_map_node[node]);
      out << '\n';
    }
    for (const std::size_t node : graph.anchors) {
      out << "FIX " << node << '\n';
    }
    for (const PoseGraphEdge& edge : graph.edges) {
      write_edge(out, edge);
    }
  });
}

PoseGraph read_g2o(const std::filesystem::path& path) { return Reader(path).read(); }

}  // namespace loopmark::pose_graph
