// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/patch_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

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

Voxel brick_voxel(const Voxel& v) { return {v.x >> 2, v.y >> 2, v.z >> 2}; }

unsigned bit_in_brick(const Voxel& v) { return static_cast<unsigned>((v.x & 3) | ((v.y & 3) << 2) | ((v.z & 3) << 4)); }

/// The bricks that hold voxels v - 1 to v + 1 along one axis, and which of their four layers those are.
struct AxisSpan {
  std::int32_t first = 0;
  int bricks = 1;
  std::array<unsigned, 2> bits{};  ///< four bits a brick
};

AxisSpan axis_span(std::int32_t v) {
  AxisSpan span;
  span.first = (v - 1) >> 2;
  const unsigned layers = 7U << static_cast<unsigned>((v - 1) & 3);  // over two bricks
  span.bits = {layers & 15U, layers >> 4U};
  span.bricks = span.bits[1] != 0 ? 2 : 1;
  return span;
}

/// For each set of layers along an axis: the bits of a brick in them. `step` is the axis' bit distance.
constexpr std::array<std::uint64_t, 16> layer_masks(unsigned step) {
  std::array<std::uint64_t, 16> masks{};
  for (unsigned set = 0; set < 16; ++set) {
    for (unsigned bit = 0; bit < 64; ++bit) {
      if ((set >> (bit / step % 4) & 1U) != 0) {
        masks[set] |= 1ULL << bit;
      }
    }
  }
  return masks;
}

constexpr auto kSpreadX = layer_masks(1);
constexpr auto kSpreadY = layer_masks(4);
constexpr auto kSpreadZ = layer_masks(16);

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

PatchMap::PatchMap(std::vector<Patch> patches, float size_m) : bricks_(patches.size() / 8), size_m_(size_m) {
  const float inverse = 1.0F / size_m;
  std::vector<std::uint32_t> brick_of(patches.size());
  std::vector<std::uint8_t> bit_of(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Voxel voxel = voxel_of(patches[i].mean, inverse);
    brick_of[i] = bricks_.insert(brick_voxel(voxel));
    bit_of[i] = static_cast<std::uint8_t>(bit_in_brick(voxel));
  }
  std::vector<std::uint32_t> order(patches.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return brick_of[a] != brick_of[b] ? brick_of[a] < brick_of[b] : bit_of[a] < bit_of[b];
  });
  contents_.resize(bricks_.size());
  patches_.reserve(patches.size());
  for (const std::uint32_t i : order) {
    Brick& brick = contents_[brick_of[i]];
    const std::uint64_t bit = 1ULL << bit_of[i];
    if (brick.occupied == 0) {
      brick.first = static_cast<std::uint32_t>(patches_.size());
    }
    if ((brick.occupied & bit) == 0) {
      brick.occupied |= bit;
      patches_.push_back(patches[i]);
    }
  }
}

const Patch* PatchMap::nearest(const Eigen::Vector3f& point, float max_distance) const {
  const Patch* best = nullptr;
  float best_distance = max_distance * max_distance;
  const Voxel centre = voxel_of(point, 1.0F / size_m_);
  const auto search_brick = [&](const Voxel& brick_at, std::uint64_t wanted) {
    const std::uint32_t found = bricks_.find(brick_at);
    if (found == VoxelTable::kNone) {
      return;
    }
    const Brick& brick = contents_[found];
    for (std::uint64_t hits = brick.occupied & wanted; hits != 0; hits &= hits - 1) {
      const std::uint64_t below = brick.occupied & ((hits & (0 - hits)) - 1);
      const Patch& patch = patches_[brick.first + static_cast<std::uint32_t>(std::popcount(below))];
      const float distance = (patch.mean - point).squaredNorm();
      if (distance < best_distance) {
        best_distance = distance;
        best = &patch;
      }
    }
  };
  // Along each axis the three voxels lie in one brick or in two.
  const AxisSpan x = axis_span(centre.x);
  const AxisSpan y = axis_span(centre.y);
  const AxisSpan z = axis_span(centre.z);
  for (int k = 0; k < z.bricks; ++k) {
    for (int j = 0; j < y.bricks; ++j) {
      for (int i = 0; i < x.bricks; ++i) {
        search_brick({x.first + i, y.first + j, z.first + k},
                     kSpreadX[x.bits[i]] & kSpreadY[y.bits[j]] & kSpreadZ[z.bits[k]]);
      }
    }
  }
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
