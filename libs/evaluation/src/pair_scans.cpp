// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/evaluation/algorithm.hpp"

namespace loopmark {
namespace {

constexpr double kVoxelM = 0.3;

const PointCloud& made_once(PointCloud& cloud, const PointCloud& from) {
  if (cloud.empty()) {
    cloud = voxel_downsampled(from, kVoxelM);
  }
  return cloud;
}

}  // namespace

const PointCloud& PairScans::small_source() { return made_once(small_source_, source_); }

const PointCloud& PairScans::small_target() { return made_once(small_target_, target_); }

}  // namespace loopmark
