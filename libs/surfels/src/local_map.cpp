// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/surfels/local_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "loopmark/core/parallel.hpp"
#include "loopmark/storage/byte_stream.hpp"

namespace loopmark::surfels {
namespace {

/// Normal of the points around one, zero where they form no plane.
Eigen::Vector3f plane_normal(const Eigen::Vector3f& sum, const Eigen::Matrix3f& products, int count) {
  constexpr int kLeastPoints = 6;
  constexpr float kFlat = 0.1F;  // thickness^2 against width^2
  constexpr float kWide = 0.3F;  // a line has no normal, and a lone ring with its noise, or two, hardly one
  if (count < kLeastPoints) {
    return Eigen::Vector3f::Zero();
  }
  const Eigen::Vector3f mean = sum / static_cast<float>(count);
  const Eigen::Matrix3f covariance = products / static_cast<float>(count) - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
  eigen.computeDirect(covariance);
  const Eigen::Vector3f& values = eigen.eigenvalues();
  if (values[0] > kFlat * values[1] || values[1] < kWide * values[2]) {
    return Eigen::Vector3f::Zero();
  }
  return eigen.eigenvectors().col(0);
}

}  // namespace

LocalMap::LocalMap(double voxel_m, std::size_t points_per_voxel)
    : voxel_m_(voxel_m),
      capacity_(std::clamp<std::size_t>(points_per_voxel, 1, kMaxPoints)),
      // As many squares of this edge as points cover one face of the voxel.
      spacing_squared_(static_cast<float>(voxel_m * voxel_m / static_cast<double>(capacity_))),
      table_(1024) {}

search::Voxel LocalMap::voxel_at(const Eigen::Vector3d& point) const {
  return {static_cast<std::int32_t>(std::floor(point.x() / voxel_m_)),
          static_cast<std::int32_t>(std::floor(point.y() / voxel_m_)),
          static_cast<std::int32_t>(std::floor(point.z() / voxel_m_))};
}

Eigen::Vector3d LocalMap::corner(const search::Voxel& voxel) const {
  return Eigen::Vector3d(voxel.x, voxel.y, voxel.z) * voxel_m_;
}

bool LocalMap::add(Cell& cell, const Eigen::Vector3f& offset) const {
  if (cell.count >= capacity_) {
    return false;
  }
  for (std::uint32_t k = 0; k < cell.count; ++k) {
    if ((cell.offset[k] - offset).squaredNorm() < spacing_squared_) {
      return false;
    }
  }
  cell.offset[cell.count] = offset;
  cell.normal[cell.count].setZero();
  ++cell.count;
  return true;
}

void LocalMap::insert(const std::vector<Eigen::Vector3d>& points) {
  std::vector<std::uint32_t> changed;
  for (const Eigen::Vector3d& point : points) {
    const search::Voxel voxel = voxel_at(point);
    const std::uint32_t cell = table_.insert(voxel);
    if (cell == cells_.size()) {
      cells_.emplace_back();
    }
    if (add(cells_[cell], (point - corner(voxel)).cast<float>())) {
      changed.push_back(cell);
    }
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  parallel_for(
      changed.size(), [&](std::size_t i) { renew_normals(changed[i]); }, 64);
}

void LocalMap::renew_normals(std::uint32_t index) {
  Cell& cell = cells_[index];
  const search::Voxel home = table_.voxels()[index];
  std::array<Eigen::Vector3f, 27 * kMaxPoints> around;
  std::size_t count = 0;
  for (int k = 0; k < 27; ++k) {
    const Eigen::Vector3i step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    const std::uint32_t other = table_.find({home.x + step.x(), home.y + step.y(), home.z + step.z()});
    if (other == search::VoxelTable::kNone) {
      continue;
    }
    const Eigen::Vector3f shift = step.cast<float>() * static_cast<float>(voxel_m_);
    for (std::uint32_t p = 0; p < cells_[other].count; ++p) {
      around[count++] = cells_[other].offset[p] + shift;
    }
  }
  const auto reach = static_cast<float>(voxel_m_ * voxel_m_);
  for (std::uint32_t p = 0; p < cell.count; ++p) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f products = Eigen::Matrix3f::Zero();
    int near = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Eigen::Vector3f offset = around[k] - cell.offset[p];
      if (offset.squaredNorm() < reach) {
        sum += offset;
        products += offset * offset.transpose();
        ++near;
      }
    }
    cell.normal[p] = plane_normal(sum, products, near);
  }
}

bool LocalMap::nearest(const Eigen::Vector3d& query, double max_distance, MapMatch& match) const {
  const search::Voxel home = voxel_at(query);
  const Eigen::Vector3f inside = (query - corner(home)).cast<float>();
  const auto edge = static_cast<float>(voxel_m_);
  const auto reach = static_cast<float>(std::min(max_distance, voxel_m_));
  float best = reach * reach;
  const Cell* best_cell = nullptr;
  std::uint32_t best_point = 0;
  search::Voxel best_voxel;
  const auto outside = [&](float x, int step) {  // distance to the neighbouring voxel along one axis
    return step == 0 ? 0.0F : (step < 0 ? x : edge - x);
  };
  for (const int dx : {0, -1, 1}) {
    const float gap_x = outside(inside.x(), dx);
    for (const int dy : {0, -1, 1}) {
      const float gap_y = outside(inside.y(), dy);
      for (const int dz : {0, -1, 1}) {
        const float gap_z = outside(inside.z(), dz);
        if (gap_x * gap_x + gap_y * gap_y + gap_z * gap_z >= best) {
          continue;
        }
        const search::Voxel voxel{home.x + dx, home.y + dy, home.z + dz};
        const std::uint32_t index = table_.find(voxel);
        if (index == search::VoxelTable::kNone) {
          continue;
        }
        const Cell& cell = cells_[index];
        const Eigen::Vector3f from =
            inside - Eigen::Vector3f(static_cast<float>(dx), static_cast<float>(dy), static_cast<float>(dz)) * edge;
        for (std::uint32_t p = 0; p < cell.count; ++p) {
          const float distance = (cell.offset[p] - from).squaredNorm();
          if (distance < best) {
            best = distance;
            best_cell = &cell;
            best_point = p;
            best_voxel = voxel;
          }
        }
      }
    }
  }
  if (best_cell == nullptr) {
    return false;
  }
  match.point = corner(best_voxel) + best_cell->offset[best_point].cast<double>();
  match.normal = best_cell->normal[best_point].cast<double>();
  match.distance_m = std::sqrt(static_cast<double>(best));
  return true;
}

void LocalMap::forget_beyond(const Eigen::Vector3d& center, double radius) {
  search::VoxelTable table(table_.size());
  std::vector<Cell> cells;
  cells.reserve(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const search::Voxel& voxel = table_.voxels()[i];
    if ((corner(voxel) - center).squaredNorm() <= radius * radius) {
      table.insert(voxel);
      cells.push_back(cells_[i]);
    }
  }
  table_ = std::move(table);
  cells_ = std::move(cells);
}

std::string LocalMap::to_bytes() const {
  storage::ByteWriter writer;
  writer.value(voxel_m_);
  writer.value(capacity_);
  writer.vector(table_.voxels());
  for (const Cell& cell : cells_) {
    writer.value(cell.count);
    for (std::uint32_t p = 0; p < cell.count; ++p) {
      writer.raw(cell.offset[p].data(), 3);
      writer.raw(cell.normal[p].data(), 3);
    }
  }
  return writer.bytes();
}

LocalMap LocalMap::from_bytes(const std::string& bytes) {
  storage::ByteReader reader(bytes);
  const auto voxel_m = reader.value<double>();
  LocalMap map(voxel_m, reader.value<std::size_t>());
  for (const search::Voxel& voxel : reader.vector<search::Voxel>()) {
    map.table_.insert(voxel);
    Cell& cell = map.cells_.emplace_back();
    cell.count = std::min<std::uint32_t>(reader.value<std::uint32_t>(), kMaxPoints);
    for (std::uint32_t p = 0; p < cell.count; ++p) {
      reader.raw(cell.offset[p].data(), 3);
      reader.raw(cell.normal[p].data(), 3);
    }
  }
  return map;
}

}  // namespace loopmark::surfels
