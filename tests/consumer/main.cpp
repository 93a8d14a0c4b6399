// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/pose.hpp"

int main() {
  const loopmark::Pose turn = loopmark::pose_from_yaw(0.5);
  const auto kept =
      loopmark::cloud::voxel_first_indices({{0.0F, 0.0F, 0.0F}, {0.1F, 0.0F, 0.0F}, {3.0F, 0.0F, 0.0F}}, 1.0);
  std::cout << kept.size() << " " << loopmark::rotation_angle_degrees(turn.linear()) << "\n";
}
