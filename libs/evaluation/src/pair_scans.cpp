// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/evaluation/algorithm.hpp"

namespace loopmark::evaluation {
namespace {

constexpr double kVoxelM = 0.3;

}  // namespace

const PointCloud& PairScans::small_source() {
  return shared<PointCloud>("small source", [&] { return cloud::voxel_downsampled(source_, kVoxelM); });
}

const PointCloud& PairScans::small_target() {
  return shared<PointCloud>("small target", [&] { return cloud::voxel_downsampled(target_, kVoxelM); });
}

}  // namespace loopmark::evaluation
