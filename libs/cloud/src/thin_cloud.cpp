// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/cloud/thin_cloud.hpp"

#include <cstring>

#include "loopmark/core/error.hpp"

namespace loopmark::cloud {
namespace {

constexpr int kTileBits = 7;  // 128 voxels
constexpr std::size_t kRecord = 4 * sizeof(float);

float inverse_of(double voxel_m) {
  if (!(voxel_m > 0.0)) {
    throw InputError("the voxel size must be above 0 m");
  }
  return static_cast<float>(1.0 / voxel_m);
}

}  // namespace

ThinCloud::ThinCloud(double voxel_m) : inverse_(inverse_of(voxel_m)), table_(0) {}

bool ThinCloud::add(const Eigen::Vector3f& point, float intensity) {
  if (table_.insert(search::voxel_of(point, inverse_)) < points_.size()) {
    return false;
  }
  points_.push_back(point);
  intensity_.push_back(intensity);
  return true;
}

std::string ThinCloud::to_bytes() const {
  std::string bytes(sizeof inverse_ + kRecord * points_.size(), '\0');
  std::memcpy(bytes.data(), &inverse_, sizeof inverse_);
  char* at = bytes.data() + sizeof inverse_;
  for (std::size_t i = 0; i < points_.size(); ++i, at += kRecord) {
    std::memcpy(at, points_[i].data(), 3 * sizeof(float));
    std::memcpy(at + 3 * sizeof(float), &intensity_[i], sizeof(float));
  }
  return bytes;
}

ThinCloud ThinCloud::from_bytes(const std::string& bytes) {
  ThinCloud cloud;
  std::memcpy(&cloud.inverse_, bytes.data(), sizeof cloud.inverse_);
  std::array<float, 4> record{};
  for (std::size_t at = sizeof cloud.inverse_; at < bytes.size(); at += kRecord) {
    std::memcpy(record.data(), bytes.data() + at, kRecord);
    cloud.add({record[0], record[1], record[2]}, record[3]);
  }
  return cloud;
}

TiledCloud::TiledCloud(double voxel_m, const std::filesystem::path& scratch, std::size_t max_points_in_memory)
    : voxel_m_(voxel_m), tiles_(scratch, max_points_in_memory) {}

void TiledCloud::add(const PointCloud& cloud) {
  with_intensity_ = with_intensity_ && !cloud.intensity.empty();
  const float inverse = inverse_of(voxel_m_);
  ThinCloud* held = nullptr;
  Key held_at{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const search::Voxel voxel = search::voxel_of(cloud.points[i], inverse);
    const Key at = {voxel.x >> kTileBits, voxel.y >> kTileBits, voxel.z >> kTileBits};
    if (held == nullptr || at != held_at) {
      held = &tiles_.at(at);
      held_at = at;
      if (held->points().empty()) {
        *held = ThinCloud(voxel_m_);
      }
    }
    size_ += held->add(cloud.points[i], cloud.intensity.empty() ? 0.0F : cloud.intensity[i]) ? 1 : 0;
  }
  tiles_.trim();
}

void TiledCloud::for_each_tile(const std::function<void(const PointCloud&)>& visit) {
  tiles_.for_each([&](const Key&, const std::string& bytes) {
    const ThinCloud tile = ThinCloud::from_bytes(bytes);
    PointCloud cloud;
    cloud.points = tile.points();
    if (with_intensity_) {
      cloud.intensity = tile.intensity();
    }
    visit(cloud);
  });
}

OverviewCloud::OverviewCloud(double voxel_m, std::size_t most) : voxel_m_(voxel_m), most_(most), cloud_(voxel_m) {}

void OverviewCloud::add(const std::vector<Eigen::Vector3f>& points) {
  for (const Eigen::Vector3f& point : points) {
    if (!cloud_.add(point) || cloud_.points().size() <= most_) {
      continue;
    }
    voxel_m_ *= 2.0;
    ThinCloud coarser(voxel_m_);
    for (const Eigen::Vector3f& kept : cloud_.points()) {
      coarser.add(kept);
    }
    cloud_ = std::move(coarser);
  }
}

}  // namespace loopmark::cloud
