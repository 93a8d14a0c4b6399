// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/patch_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "loopmark/core/parallel.hpp"

namespace loopmark {
namespace {

/// Sums over points. Levelled coordinates stay below 200 m: double keeps a micrometre.
struct Moments {
  double count = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& p) {
    count += 1.0;
    sum += p;
    squares += p * p.transpose();
  }
  void add(const Moments& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }
};

template <class Function>
void for_each_neighbour(const VoxelTable& table, const Voxel& centre, const Function& visit) {
  for (std::int32_t dz = -1; dz <= 1; ++dz) {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      for (std::int32_t dx = -1; dx <= 1; ++dx) {
        const std::uint32_t found = table.find({centre.x + dx, centre.y + dy, centre.z + dz});
        if (found != VoxelTable::kNone) {
          visit(found);
        }
      }
    }
  }
}

/// Normal and planarity of the spread around a mean: planarity = (l1 - l0) / l2 of the ordered eigenvalues.
void set_shape(Patch& patch, const Moments& m) {
  if (m.count < 5.0) {
    return;
  }
  const Eigen::Vector3d mean = m.sum / m.count;
  const Eigen::Matrix3d spread = m.squares / m.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(spread);
  const Eigen::Vector3d l = solver.eigenvalues();
  patch.normal = solver.eigenvectors().col(0).cast<float>();
  patch.planarity = static_cast<float>(std::clamp((l[1] - l[0]) / std::max(l[2], 1e-9), 0.0, 1.0));
}

}  // namespace

PatchMap::PatchMap(std::vector<Patch> patches, float size_m) : table_(patches.size()), size_m_(size_m) {
  const float inverse = 1.0F / size_m;
  patches_.reserve(patches.size());
  for (const Patch& patch : patches) {
    if (table_.insert(voxel_of(patch.mean, inverse)) == patches_.size()) {
      patches_.push_back(patch);
    }
  }
}

const Patch* PatchMap::nearest(const Eigen::Vector3f& point, float max_distance) const {
  const Patch* best = nullptr;
  float best_distance = max_distance * max_distance;
  for_each_neighbour(table_, voxel_of(point, 1.0F / size_m_), [&](std::uint32_t i) {
    const float distance = (patches_[i].mean - point).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best = &patches_[i];
    }
  });
  return best;
}

std::vector<Patch> make_patches(const std::vector<Eigen::Vector3f>& points, float size_m) {
  VoxelTable table(points.size() / 6);
  std::vector<Moments> moments;
  const float inverse = 1.0F / size_m;
  for (const Eigen::Vector3f& p : points) {
    const std::uint32_t voxel = table.insert(voxel_of(p, inverse));
    if (voxel == moments.size()) {
      moments.emplace_back();
    }
    moments[voxel].add(p.cast<double>());
  }
  std::vector<Patch> patches(moments.size());
  parallel_blocks(moments.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Moments around;
      for_each_neighbour(table, table.voxels()[i], [&](std::uint32_t k) { around.add(moments[k]); });
      patches[i].mean = (moments[i].sum / moments[i].count).cast<float>();
      set_shape(patches[i], around);
    }
  });
  return patches;
}

std::vector<Patch> coarsened(const PatchMap& fine, int factor) {
  const float size = fine.size_m() * static_cast<float>(factor);
  VoxelTable table(fine.patches().size() / 4);
  std::vector<Patch> patches;
  std::vector<float> counts;
  for (const Patch& patch : fine.patches()) {
    const std::uint32_t voxel = table.insert(voxel_of(patch.mean, 1.0F / size));
    if (voxel == patches.size()) {
      patches.push_back(patch);
      counts.push_back(1.0F);
      continue;
    }
    Patch& joined = patches[voxel];
    counts[voxel] += 1.0F;
    joined.mean += (patch.mean - joined.mean) / counts[voxel];
    joined.height += (patch.height - joined.height) / counts[voxel];
    if (patch.planarity > joined.planarity) {
      joined.normal = patch.normal;
      joined.planarity = patch.planarity;
    }
  }
  return patches;
}

}  // namespace loopmark
