// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/pair_sets/candidate_pool.hpp"
#include "loopmark/search/voxel.hpp"
#include "overlap_probe.hpp"

namespace loopmark::pair_sets {
namespace {

struct FramePlace {
  std::size_t drive = 0;
  std::size_t place = 0;
};

/// Frames of all drives by where they were taken.
class FrameMap {
 public:
  FrameMap(const std::vector<Drive>& drives, double cell_m) : drives_(drives), cell_m_(cell_m) {
    for (std::size_t d = 0; d < drives.size(); ++d) {
      for (std::size_t p = 0; p < drives[d].size(); ++p) {
        cells_[cell_of(position({d, p}))].push_back({d, p});
      }
    }
  }

  Eigen::Vector3d position(const FramePlace& frame) const {
    return drives_[frame.drive].T_world_cloud[frame.place].translation();
  }

  /// Frames within cell_m of a frame, in a fixed order.
  std::vector<FramePlace> near(const FramePlace& frame) const {
    std::vector<FramePlace> frames;
    const search::Voxel centre = cell_of(position(frame));
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = cells_.find({centre.x + dx, centre.y + dy, 0});
        if (cell == cells_.end()) {
          continue;
        }
        std::copy_if(cell->second.begin(), cell->second.end(), std::back_inserter(frames),
                     [&](const FramePlace& other) { return (position(other) - position(frame)).norm() <= cell_m_; });
      }
    }
    return frames;
  }

 private:
  search::Voxel cell_of(const Eigen::Vector3d& p) const {
    return {static_cast<int>(std::floor(p.x() / cell_m_)), static_cast<int>(std::floor(p.y() / cell_m_)), 0};
  }

  const std::vector<Drive>& drives_;
  double cell_m_;
  std::unordered_map<search::Voxel, std::vector<FramePlace>, search::VoxelHash> cells_;
};

/// Frames that see the source's place at another time.
std::vector<FramePlace> revisits_of(const FramePlace& source, const FrameMap& map, const std::vector<Drive>& drives,
                                    bool one_world, const BalanceOptions& options) {
  std::vector<FramePlace> frames = map.near(source);
  const double stamp = drives[source.drive].stamps_s[source.place];
  std::erase_if(frames, [&](const FramePlace& other) {
    return other.drive == source.drive
               ? std::abs(drives[other.drive].stamps_s[other.place] - stamp) <= options.max_gap_s
               : !one_world;
  });
  return frames;
}

std::vector<RegistrationPair> candidate_of(const FramePlace& source, const FrameMap& map,
                                           const std::vector<Drive>& drives, bool one_world,
                                           const BalanceOptions& options) {
  check_interrupt();
  const std::vector<FramePlace> frames = revisits_of(source, map, drives, one_world, options);
  if (frames.empty()) {
    return {};
  }
  const Drive& drive = drives[source.drive];
  Rng rng(task_seed(options.seed, {0x72657669U, static_cast<std::uint64_t>(drive.session), source.place}));
  PoolCost cost;
  internal::OverlapProbe probe(drive, source.place, cost);
  constexpr int kDraws = 6;
  for (int i = 0; i < kDraws; ++i) {
    const FramePlace& target = frames[rng.below(static_cast<std::uint32_t>(frames.size()))];
    const cloud::Overlap overlap = probe.with(drives[target.drive], target.place);
    if (internal::chosen(overlap, options) >= options.min_overlap) {
      return {probe.pair(drives[target.drive], target.place, overlap)};
    }
  }
  return {};
}

}  // namespace

std::vector<RegistrationPair> make_revisit_pool(const std::vector<Drive>& drives, std::size_t pairs, bool one_world,
                                                const BalanceOptions& options) {
  check(options);
  const FrameMap map(drives, options.revisit_distance_m);
  const std::size_t spacing = source_spacing(drives, pairs, options);
  std::vector<FramePlace> sources;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    for (std::size_t p = 0; p < drives[d].size(); p += spacing) {
      sources.push_back({d, p});
    }
  }
  std::vector<std::vector<RegistrationPair>> found(sources.size());
  parallel_for(sources.size(),
               [&](std::size_t i) { found[i] = candidate_of(sources[i], map, drives, one_world, options); });
  std::vector<RegistrationPair> pool;
  for (const auto& part : found) {
    pool.insert(pool.end(), part.begin(), part.end());
  }
  return pool;
}

}  // namespace loopmark::pair_sets
