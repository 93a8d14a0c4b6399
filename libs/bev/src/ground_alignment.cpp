// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/ground_alignment.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "loopmark/core/random.hpp"
#include "loopmark/search/voxel_table.hpp"

namespace loopmark::bev {
namespace {

constexpr float kNear = 3.0F;
constexpr float kFar = 30.0F;
constexpr float kThickness = 0.15F;  // metres to either side of the plane
constexpr float kBelow = 0.5F;       // metres below the plane that speak against it
constexpr float kBelowWeight = 2.0F;
constexpr float kBeside = 10.0F;      // metres: farther away, land may lie below a street on a bridge or a bank
constexpr float kMinUpright = 0.82F;  // cosine of 35 degrees
constexpr float kUsualTilt = 0.17F;   // radians: a car's sensor is tilted by less; a roof or a bank is not
constexpr float kTiltDoubt = 3.0F;    // a radian more costs this share of the points
constexpr int kTrials = 400;
constexpr float kSquare = 1.5F;  // metres
constexpr std::size_t kMaxPoints = 3000;
constexpr double kUsualHeight = 1.7;  // metres, where no ground is seen

struct Plane {
  Eigen::Vector3f normal;
  float offset = 0.0F;  // height of the sensor above the plane: normal . p + offset is a point's height

  float height(const Eigen::Vector3f& p) const { return normal.dot(p) + offset; }
};

std::vector<Eigen::Vector3f> near_points(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> near;
  for (const Eigen::Vector3f& p : points) {
    const float range = p.head<2>().norm();
    if (range > kNear && range < kFar) {
      near.push_back(p);
    }
  }
  const std::size_t stride = near.size() / kMaxPoints + 1;
  std::vector<Eigen::Vector3f> thinned;
  for (std::size_t i = 0; i < near.size(); i += stride) {
    thinned.push_back(near[i]);
  }
  return thinned;
}

/// The lowest point of each square of the ground plane: most of them are ground, also between walls, where most points
/// are not and three at random would hardly ever all be.
std::vector<Eigen::Vector3f> lowest_points(const std::vector<Eigen::Vector3f>& points) {
  search::VoxelTable squares(points.size());
  std::vector<Eigen::Vector3f> lowest;
  for (const Eigen::Vector3f& p : points) {
    const std::uint32_t square = squares.insert(search::voxel_of({p.x(), p.y(), 0.0F}, 1.0F / kSquare));
    if (square == lowest.size()) {
      lowest.push_back(p);
    } else if (p.z() < lowest[square].z()) {
      lowest[square] = p;
    }
  }
  return lowest;
}

std::optional<Plane> plane_through(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  Eigen::Vector3f normal = (b - a).cross(c - a);
  const float length = normal.norm();
  if (length < 1e-2F) {
    return std::nullopt;
  }
  normal *= (normal.z() < 0.0F ? -1.0F : 1.0F) / length;
  const Plane plane{normal, -normal.dot(a)};
  // The sensor is above the ground.
  return normal.z() > kMinUpright && plane.offset > 0.2F ? std::optional(plane) : std::nullopt;
}

float score(const Plane& plane, const std::vector<Eigen::Vector3f>& points) {
  int on = 0;
  int below = 0;
  for (const Eigen::Vector3f& p : points) {
    const float h = plane.height(p);
    on += std::abs(h) < kThickness ? 1 : 0;
    below += h < -kBelow && p.head<2>().squaredNorm() < kBeside * kBeside ? 1 : 0;
  }
  const float excess = std::max(0.0F, std::acos(std::min(1.0F, plane.normal.z())) - kUsualTilt);
  const float trust = std::max(0.0F, 1.0F - kTiltDoubt * excess);
  return trust * static_cast<float>(on) - kBelowWeight * static_cast<float>(below);
}

std::optional<Plane> least_squares(const Plane& start, const std::vector<Eigen::Vector3f>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (const Eigen::Vector3f& p : points) {
    if (std::abs(start.height(p)) < kThickness) {
      const Eigen::Vector3d q = p.cast<double>();
      mean += q;
      second += q * q.transpose();
      count += 1.0;
    }
  }
  if (count < 20.0) {
    return std::nullopt;
  }
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / count - mean * mean.transpose());
  Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
  normal *= normal.z() < 0.0F ? -1.0F : 1.0F;
  return normal.z() > kMinUpright ? std::optional(Plane{normal, -normal.dot(mean.cast<float>())}) : std::nullopt;
}

std::optional<Plane> best_plane(const std::vector<Eigen::Vector3f>& points) {
  Rng rng(points.size());
  std::optional<Plane> best;
  float best_score = 0.0F;
  const std::vector<Eigen::Vector3f> low = lowest_points(points);
  const auto count = static_cast<std::uint32_t>(low.size());
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto plane = plane_through(low[rng.below(count)], low[rng.below(count)], low[rng.below(count)]);
    const float value = plane ? score(*plane, points) : 0.0F;
    if (value > best_score) {
      best_score = value;
      best = plane;
    }
  }
  for (int round = 0; best && round < 3; ++round) {
    const auto better = least_squares(*best, points);
    if (!better || score(*better, points) < best_score) {
      break;
    }
    best_score = score(*better, points);
    best = better;
  }
  return best;
}

}  // namespace

GroundAlignment find_ground_alignment(const std::vector<Eigen::Vector3f>& points) {
  GroundAlignment ground_alignment;
  ground_alignment.T_level_sensor.translation().z() = kUsualHeight;
  const std::vector<Eigen::Vector3f> near = near_points(points);
  if (near.size() < 50) {
    return ground_alignment;
  }
  const std::optional<Plane> plane = best_plane(near);
  if (!plane) {
    return ground_alignment;
  }
  const auto on = std::count_if(near.begin(), near.end(),
                                [&](const Eigen::Vector3f& p) { return std::abs(plane->height(p)) < kThickness; });
  ground_alignment.found = true;
  ground_alignment.ground_share = static_cast<double>(on) / static_cast<double>(near.size());
  ground_alignment.T_level_sensor.linear() =
      Eigen::Quaterniond::FromTwoVectors(plane->normal.cast<double>(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  ground_alignment.T_level_sensor.translation().z() = plane->offset;
  return ground_alignment;
}

}  // namespace loopmark::bev
