// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Synthetic drives with known truth for the pose graph tests.
#pragma once

#include <cmath>
#include <numbers>

#include "loopmark/core/random.hpp"
#include "loopmark/pose_graph/pose_graph.hpp"

namespace loopmark::testing {

inline Vector6d noise(Rng& rng, double sigma_m, double sigma_deg) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) {
    xi[i] = rng.normal() * (i < 3 ? sigma_m : sigma_deg * std::numbers::pi / 180.0);
  }
  return xi;
}

inline Matrix6d information(double sigma_m, double sigma_deg) {
  Vector6d diagonal;
  const double sigma_rad = sigma_deg * std::numbers::pi / 180.0;
  diagonal << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return diagonal.asDiagonal();
}

struct Drive {
  pose_graph::PoseGraph graph;
  std::vector<Pose> truth;
  double odometry_sigma_m = 0.02;
  double odometry_sigma_deg = 0.05;
  double loop_sigma_m = 0.05;
  double loop_sigma_deg = 0.2;
};

/// `laps` rounds of a hilly circuit of about `length` metres with a keyframe every two metres, odometry with noise;
/// no loops yet. Initial poses are chained odometry.
inline Drive circuit(std::size_t laps, double length, Rng& rng) {
  Drive drive;
  const auto per_lap = static_cast<std::size_t>(length / 2.0);
  const double radius = length / (2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < laps * per_lap; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(per_lap);
    drive.truth.push_back(
        pose_from_yaw(angle + std::numbers::pi / 2.0,
                      {radius * std::cos(angle), radius * std::sin(angle), 3.0 * std::sin(2.0 * angle)}));
  }
  drive.graph.T_map_node = {drive.truth.front()};
  for (std::size_t i = 1; i < drive.truth.size(); ++i) {
    const Pose step = exp_se3(noise(rng, drive.odometry_sigma_m, drive.odometry_sigma_deg)) *
                      drive.truth[i - 1].inverse() * drive.truth[i];
    drive.graph.edges.push_back({i - 1, i, step, information(drive.odometry_sigma_m, drive.odometry_sigma_deg),
                                 pose_graph::EdgeKind::kOdometry});
    drive.graph.T_map_node.push_back(drive.graph.T_map_node.back() * step);
  }
  return drive;
}

inline void add_loop(Drive& drive, std::size_t from, std::size_t to, Rng& rng) {
  const Pose T =
      exp_se3(noise(rng, drive.loop_sigma_m, drive.loop_sigma_deg)) * drive.truth[from].inverse() * drive.truth[to];
  drive.graph.edges.push_back(
      {from, to, T, information(drive.loop_sigma_m, drive.loop_sigma_deg), pose_graph::EdgeKind::kLoop});
}

/// A loop between random places that claims they are within a few metres: what aliasing produces.
inline void add_wrong_loop(Drive& drive, Rng& rng) {
  const auto count = static_cast<std::uint32_t>(drive.truth.size());
  const std::size_t from = rng.below(count / 2);
  const std::size_t to = from + count / 4 + rng.below(count / 4);
  const Pose T =
      pose_from_yaw(rng.uniform(-0.2, 0.2), {rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-0.3, 0.3)});
  drive.graph.edges.push_back(
      {from, to, T, information(drive.loop_sigma_m, drive.loop_sigma_deg), pose_graph::EdgeKind::kLoop});
}

/// `count` loops that are wrong in the same way, as between two blocks that look alike: all agree with one another that
/// the second half of the drive passes `shift` further on, every `spacing` nodes.
inline void add_alike_wrong_loops(Drive& drive, std::size_t count, std::size_t spacing, const Pose& shift, Rng& rng) {
  const std::size_t half = drive.truth.size() / 2;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = half / 5 + i * spacing;
    const std::size_t to = half + half / 5 + i * spacing;
    const Pose T = exp_se3(noise(rng, drive.loop_sigma_m, drive.loop_sigma_deg)) * drive.truth[from].inverse() * shift *
                   drive.truth[to];
    drive.graph.edges.push_back(
        {from, to, T, information(drive.loop_sigma_m, drive.loop_sigma_deg), pose_graph::EdgeKind::kLoop});
  }
}

/// Root mean square of the positions' errors, both in the frame of the first node.
inline double ate(const std::vector<Pose>& estimate, const std::vector<Pose>& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose error = (truth[0].inverse() * truth[i]).inverse() * (estimate[0].inverse() * estimate[i]);
    sum += error.translation().squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

}  // namespace loopmark::testing
