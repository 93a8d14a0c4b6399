// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pose_graph/g2o.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "drives.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::pose_graph {
namespace {

using namespace testing;
using ::testing::HasSubstr;

class G2o : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void expect_refused(const std::string& content, const std::string& problem) const {
    storage::write_file_atomically(file_, content);
    try {
      read_g2o(file_);
      FAIL() << "accepted: " << content;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file_.string()));
      EXPECT_THAT(error.what(), HasSubstr(problem));
    }
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("loopmark_g2o_" + std::to_string(::getpid()));
  std::filesystem::path file_ = folder_ / "graph.g2o";
};

TEST_F(G2o, RoundTripKeepsTheProblem) {
  Rng rng(1);
  Drive drive = circuit(2, 60.0, rng);
  add_loop(drive, 3, 35, rng);
  add_loop(drive, 4, 5, rng);
  drive.graph.edges.back().kind = EdgeKind::kForced;
  drive.graph.edges.push_back(
      {2, 4, drive.truth[2].inverse() * drive.truth[4], information(0.1, 1), EdgeKind::kOdometry});
  drive.graph.anchors = {2};
  write_g2o(file_, drive.graph);
  const PoseGraph back = read_g2o(file_);
  ASSERT_EQ(back.edges.size(), drive.graph.edges.size());
  ASSERT_EQ(back.T_map_node.size(), drive.graph.T_map_node.size());
  EXPECT_EQ(back.anchors, drive.graph.anchors);
  for (std::size_t e = 0; e < back.edges.size(); ++e) {
    const PoseGraphEdge& a = back.edges[e];
    const PoseGraphEdge& b = drive.graph.edges[e];
    EXPECT_EQ(std::tie(a.from, a.to, a.kind), std::tie(b.from, b.to, b.kind));
    EXPECT_LT((a.T_from_to.matrix() - b.T_from_to.matrix()).norm(), 1e-12);
    EXPECT_LT((a.information - b.information).norm(), 1e-9 * b.information.norm());
  }
}

TEST_F(G2o, InformationIsThatOfTheErrorG2oUses) {
  // g2o: error = [t; vector part of q] of Z^-1 * T_from^-1 * T_to. Its chi2 must be ours for a small error.
  PoseGraph graph;
  Rng rng(2);
  const Pose z = exp_se3(noise(rng, 3.0, 60.0));
  graph.T_map_node = {Pose::Identity(), exp_se3(noise(rng, 1e-4, 1e-3)) * z};
  const Matrix6d half = Matrix6d::Random();
  graph.edges.push_back({0, 1, z, half * half.transpose() + Matrix6d::Identity(), EdgeKind::kOdometry});
  write_g2o(file_, graph);
  std::ifstream stream(file_);
  std::string tag;
  while (stream >> tag && tag != "EDGE_SE3:QUAT") {
  }
  double skipped = 0.0;
  for (int i = 0; i < 9; ++i) {
    stream >> skipped;
  }
  Matrix6d written;
  for (int r = 0; r < 6; ++r) {
    for (int c = r; c < 6; ++c) {
      stream >> written(r, c);
      written(c, r) = written(r, c);
    }
  }
  const Pose delta = z.inverse() * graph.T_map_node[0].inverse() * graph.T_map_node[1];
  Vector6d error;
  error << delta.translation(), Eigen::Quaterniond(delta.linear()).vec();
  const Vector6d ours = log_se3(graph.T_map_node[0].inverse() * graph.T_map_node[1] * z.inverse());
  const double expected = ours.dot(graph.edges[0].information * ours);
  EXPECT_NEAR(error.dot(written * error) / expected, 1.0, 1e-3);
}

TEST_F(G2o, ReadsWhatOthersWrite) {
  storage::write_file_atomically(file_,
                                 "# a comment\nVERTEX_SE3:QUAT 10 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 12 2 0 0 0 0 0 1\n"
                                 "VERTEX_SE3:QUAT 11 1 0 0 0 0 0 1\n\nEDGE_SE3:QUAT 10 11 1 0 0 0 0 0 1 "
                                 "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\nEDGE_SE3:QUAT 10 12 2 0 0 0 0 0 1 "
                                 "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\n");
  const PoseGraph graph = read_g2o(file_);
  ASSERT_EQ(graph.T_map_node.size(), 3U);
  EXPECT_EQ(graph.T_map_node[2].translation().x(), 2.0);
  EXPECT_EQ(graph.edges[0].kind, EdgeKind::kOdometry);
  EXPECT_EQ(graph.edges[1].kind, EdgeKind::kLoop);
  EXPECT_NEAR(graph.edges[0].information(3, 3), 1.0, 1e-12);  // 4 for half the angle
}

TEST_F(G2o, NamesTheLineThatMakesNoSense) {
  expect_refused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0\n", ":1: the line ends too early");
  expect_refused("\nVERTEX_SE3:QUAT 0 0 nan 0 0 0 0 1\n", ":2: \"nan\" is no finite number");
  expect_refused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 3\n", "quaternion");
  expect_refused("VERTEX_SE2 0 0 0 0\n", "unknown tag");
  expect_refused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n", ":2: vertex 0 is there twice");
  expect_refused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nFIX 3\n", "no vertex 3");
  EXPECT_THROW(read_g2o(folder_ / "missing.g2o"), InputError);
  EXPECT_THROW(write_g2o("/proc/graph.g2o", {}), InputError);
}

}  // namespace
}  // namespace loopmark::pose_graph
