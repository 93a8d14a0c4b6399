// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/surfels/surfel_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "loopmark/core/parallel.hpp"

namespace loopmark::surfels {
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
void for_each_neighbour(const search::VoxelTable& table, const search::Voxel& centre, const Function& visit) {
  for (std::int32_t dz = -1; dz <= 1; ++dz) {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      for (std::int32_t dx = -1; dx <= 1; ++dx) {
        const std::uint32_t found = table.find({centre.x + dx, centre.y + dy, centre.z + dz});
        if (found != search::VoxelTable::kNone) {
          visit(found);
        }
      }
    }
  }
}

search::Voxel brick_voxel(const search::Voxel& v) { return {v.x >> 2, v.y >> 2, v.z >> 2}; }

unsigned bit_in_brick(const search::Voxel& v) {
  return static_cast<unsigned>((v.x & 3) | ((v.y & 3) << 2) | ((v.z & 3) << 4));
}

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
void set_shape(Surfel& surfel, const Moments& m) {
  if (m.count < 5.0) {
    return;
  }
  const Eigen::Vector3d mean = m.sum / m.count;
  const Eigen::Matrix3d spread = m.squares / m.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(spread);
  const Eigen::Vector3d l = solver.eigenvalues();
  surfel.normal = solver.eigenvectors().col(0).cast<float>();
  surfel.planarity = static_cast<float>(std::clamp((l[1] - l[0]) / std::max(l[2], 1e-9), 0.0, 1.0));
}

}  // namespace

SurfelMap::SurfelMap(std::vector<Surfel> surfels, float size_m) : bricks_(surfels.size() / 8), size_m_(size_m) {
  const float inverse = 1.0F / size_m;
  std::vector<std::uint32_t> brick_of(surfels.size());
  std::vector<std::uint8_t> bit_of(surfels.size());
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const search::Voxel voxel = search::voxel_of(surfels[i].mean, inverse);
    brick_of[i] = bricks_.insert(brick_voxel(voxel));
    bit_of[i] = static_cast<std::uint8_t>(bit_in_brick(voxel));
  }
  std::vector<std::uint32_t> order(surfels.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return brick_of[a] != brick_of[b] ? brick_of[a] < brick_of[b] : bit_of[a] < bit_of[b];
  });
  contents_.resize(bricks_.size());
  surfels_.reserve(surfels.size());
  for (const std::uint32_t i : order) {
    Brick& brick = contents_[brick_of[i]];
    const std::uint64_t bit = 1ULL << bit_of[i];
    if (brick.occupied == 0) {
      brick.first = static_cast<std::uint32_t>(surfels_.size());
    }
    if ((brick.occupied & bit) == 0) {
      brick.occupied |= bit;
      surfels_.push_back(surfels[i]);
    }
  }
}

const Surfel* SurfelMap::nearest(const Eigen::Vector3f& point, float max_distance) const {
  const Surfel* best = nullptr;
  float best_distance = max_distance * max_distance;
  const search::Voxel centre = search::voxel_of(point, 1.0F / size_m_);
  const auto search_brick = [&](const search::Voxel& brick_at, std::uint64_t wanted) {
    const std::uint32_t found = bricks_.find(brick_at);
    if (found == search::VoxelTable::kNone) {
      return;
    }
    const Brick& brick = contents_[found];
    for (std::uint64_t hits = brick.occupied & wanted; hits != 0; hits &= hits - 1) {
      const std::uint64_t below = brick.occupied & ((hits & (0 - hits)) - 1);
      const Surfel& surfel = surfels_[brick.first + static_cast<std::uint32_t>(std::popcount(below))];
      const float distance = (surfel.mean - point).squaredNorm();
      if (distance < best_distance) {
        best_distance = distance;
        best = &surfel;
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

std::vector<Surfel> make_surfels(const std::vector<Eigen::Vector3f>& points, float size_m) {
  search::VoxelTable table(points.size() / 6);
  std::vector<Moments> moments;
  const float inverse = 1.0F / size_m;
  for (const Eigen::Vector3f& p : points) {
    const std::uint32_t voxel = table.insert(search::voxel_of(p, inverse));
    if (voxel == moments.size()) {
      moments.emplace_back();
    }
    moments[voxel].add(p.cast<double>());
  }
  std::vector<Surfel> surfels(moments.size());
  parallel_blocks(moments.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Moments around;
      for_each_neighbour(table, table.voxels()[i], [&](std::uint32_t k) { around.add(moments[k]); });
      surfels[i].mean = (moments[i].sum / moments[i].count).cast<float>();
      set_shape(surfels[i], around);
    }
  });
  return surfels;
}

std::vector<Surfel> coarsened(const SurfelMap& fine, int factor) {
  const float size = fine.size_m() * static_cast<float>(factor);
  search::VoxelTable table(fine.surfels().size() / 4);
  std::vector<Surfel> surfels;
  std::vector<float> counts;
  for (const Surfel& surfel : fine.surfels()) {
    const std::uint32_t voxel = table.insert(search::voxel_of(surfel.mean, 1.0F / size));
    if (voxel == surfels.size()) {
      surfels.push_back(surfel);
      counts.push_back(1.0F);
      continue;
    }
    Surfel& joined = surfels[voxel];
    counts[voxel] += 1.0F;
    joined.mean += (surfel.mean - joined.mean) / counts[voxel];
    joined.height += (surfel.height - joined.height) / counts[voxel];
    if (surfel.planarity > joined.planarity) {
      joined.normal = surfel.normal;
      joined.planarity = surfel.planarity;
    }
  }
  return surfels;
}

}  // namespace loopmark::surfels
