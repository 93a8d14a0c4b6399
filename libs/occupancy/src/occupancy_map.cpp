// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/occupancy/occupancy_map.hpp"

#include <unistd.h>

#include <atomic>
#include <string>

#include "apply_scan.hpp"
#include "tree_writer.hpp"

namespace loopmark::occupancy {
namespace {

using namespace occupancy;

/// A name that no other builder of this or another process uses.
std::filesystem::path scratch_path(const std::filesystem::path& folder, const std::string& what) {
  static std::atomic<unsigned> count{0};
  return folder / ("." + what + "-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
}

std::size_t block_budget(const OccupancyOptions& options) {
  return options.memory_mb * (1U << 20U) / sizeof(internal::Block);
}

std::vector<Eigen::Vector3f> moved(const std::vector<Eigen::Vector3f>& points, const Pose& T_map_sensor) {
  std::vector<Eigen::Vector3f> in_map;
  in_map.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    in_map.push_back((T_map_sensor * p.cast<double>()).cast<float>());
  }
  return in_map;
}

}  // namespace

struct OccupancyMapBuilder::State {
  State(const OccupancyOptions& o, const std::filesystem::path& folder)
      : options(o), scratch(folder), caster(o), odds(o), store(scratch_path(folder, "tiles"), block_budget(o)) {}

  OccupancyOptions options;
  std::filesystem::path scratch;
  internal::RayCaster caster;
  internal::LogOdds odds;
  internal::TileStore store;
  OccupancyStatistics statistics;
};

OccupancyMapBuilder::OccupancyMapBuilder(const OccupancyOptions& options, const std::filesystem::path& scratch_folder) {
  check(options);
  state_ = std::make_unique<State>(options, scratch_folder);
}

OccupancyMapBuilder::~OccupancyMapBuilder() = default;

void OccupancyMapBuilder::insert(const std::vector<Eigen::Vector3f>& points, const Pose& T_map_sensor) {
  const internal::ScanVoxels& voxels =
      state_->caster.cast(moved(points, T_map_sensor), T_map_sensor.translation().cast<float>());
  internal::apply_scan(voxels, state_->odds, state_->store);
  state_->store.trim();
  ++state_->statistics.scans;
  state_->statistics.rays += voxels.rays;
  state_->statistics.skipped_points += voxels.skipped_points;
}

OccupancyStatistics OccupancyMapBuilder::write(const std::filesystem::path& bt, const std::filesystem::path& ot) {
  const double resolution = state_->options.resolution_m;
  internal::TreeWriter binary(internal::TreeFormat::kBinary, resolution, scratch_path(state_->scratch, "bt"));
  internal::TreeWriter full(internal::TreeFormat::kFull, resolution, scratch_path(state_->scratch, "ot"));
  state_->store.for_each([&](std::uint32_t number, const std::string& bytes) {
    binary.add(number, internal::binary_subtree(bytes));
    full.add(number, internal::full_subtree(bytes));
  });
  if (!bt.empty()) {
    binary.write(bt);
  }
  if (!ot.empty()) {
    state_->statistics.nodes = full.write(ot);
  }
  state_->statistics.tiles = state_->store.size();
  state_->statistics.spilled_tiles = state_->store.spilled();
  return state_->statistics;
}

void check(const OccupancyOptions& o) {
  require_option(o.resolution_m >= 0.01 && o.resolution_m <= 100.0, "resolution_m", "must be 0.01 to 100");
  require_option(o.max_range_m > o.resolution_m && o.max_range_m / o.resolution_m <= 1000.0, "max_range_m",
                 "must be more than a voxel and at most 1000 voxels");
  require_option(o.hit_probability > 0.5 && o.hit_probability < 1.0, "hit_probability", "must be above 0.5, below 1");
  require_option(o.miss_probability > 0.0 && o.miss_probability < 0.5, "miss_probability",
                 "must be above 0, below 0.5");
  require_option(o.min_probability > 0.0 && o.min_probability < 0.5, "min_probability", "must be above 0, below 0.5");
  require_option(o.max_probability > 0.5 && o.max_probability < 1.0, "max_probability", "must be above 0.5, below 1");
  require_option(o.memory_mb >= 1, "memory_mb", "must be at least 1");
}

}  // namespace loopmark::occupancy
