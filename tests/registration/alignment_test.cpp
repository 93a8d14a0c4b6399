// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/registration/src/alignment.hpp"

#include <gtest/gtest.h>

namespace loopmark::registration {
namespace {

constexpr float kReach = 0.4F;
constexpr double kScale = 0.2;
constexpr int kRounds = 10;

/// Surfels of three walls that stand square to each other, every `step_m`, in the frame that T_frame_world leads to.
/// Those with a planarity of 0 are as of lone rings: where they are is known, the surface is not.
surfels::SurfelMap corner(float step_m, float offset_m, float planarity, const Pose& T_frame_world) {
  std::vector<surfels::Surfel> surfels;
  for (int axis = 0; axis < 3; ++axis) {
    for (float u = offset_m; u < 10.0F; u += step_m) {
      for (float v = offset_m; v < 10.0F; v += step_m) {
        Eigen::Vector3f p = Eigen::Vector3f::Zero();
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        surfels::Surfel surfel;
        surfel.mean = T_frame_world.cast<float>() * p;
        surfel.normal = T_frame_world.linear().cast<float>() * Eigen::Vector3f::Unit(axis);
        surfel.planarity = planarity;
        surfel.height = 1.0F;
        surfels.push_back(surfel);
      }
    }
  }
  return {surfels, kFineSurfel};
}

const Pose kTruth = exp_se3((Vector6d() << 3.0, -2.0, 0.5, 0.02, -0.03, 0.8).finished());
const Pose kStart = exp_se3((Vector6d() << 0.08, -0.06, 0.1, 0.006, -0.006, 0.008).finished()) * kTruth;

surfels::SurfelMap source_of(float planarity) { return corner(0.45F, 0.1F, planarity, kTruth.inverse()); }
surfels::SurfelMap target_of(float planarity) { return corner(0.45F, 0.25F, planarity, Pose::Identity()); }

TEST(AlignBothWays, FindsTheMotion) {
  const internal::Alignment found =
      internal::align_both_ways(source_of(1.0F), target_of(1.0F), kStart, kReach, kScale, kRounds);
  const PoseError error = pose_error(found.T_target_source, kTruth);
  EXPECT_LT(error.translation_m, 0.03);
  EXPECT_LT(error.rotation_deg, 0.1);
}

TEST(AlignBothWays, WhichScanIsTheSourceMakesNoDifference) {
  const surfels::SurfelMap a = source_of(1.0F);
  const surfels::SurfelMap b = target_of(0.8F);
  const Pose there = internal::align_both_ways(a, b, kStart, kReach, kScale, kRounds).T_target_source;
  const Pose back = internal::align_both_ways(b, a, kStart.inverse(), kReach, kScale, kRounds).T_target_source;
  const PoseError error = pose_error(there, back.inverse());
  EXPECT_LT(error.translation_m, 2e-3);
  EXPECT_LT(error.rotation_deg, 0.02);
}

TEST(AlignBothWays, SurfacesOfTheSourceHoldASparseTarget) {
  const surfels::SurfelMap dense = source_of(1.0F);
  const surfels::SurfelMap rings = target_of(0.0F);
  const auto off = [&](const internal::Alignment& found) {
    return pose_error(found.T_target_source, kTruth).translation_m;
  };
  const double one_way = off(internal::align_surfels(dense.surfels(), rings, kStart, kReach, kScale, kRounds));
  EXPECT_LT(off(internal::align_both_ways(dense, rings, kStart, kReach, kScale, kRounds)), 0.7 * one_way);
}

}  // namespace
}  // namespace loopmark::registration
