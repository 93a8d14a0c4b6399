// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pair_sets/hard_negatives.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "overlap_probe.hpp"

namespace loopmark::pair_sets {
namespace {

constexpr int kRings = 20;
constexpr int kSectors = 60;
constexpr double kReachM = 80.0;
/// Frames that are described for each pair asked for.
constexpr std::size_t kFramesPerPair = 10;

struct Described {
  std::size_t drive = 0;
  std::size_t place = 0;
  std::vector<float> descriptor;
};

float ground_level(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> heights;
  heights.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    heights.push_back(point.z());
  }
  const auto tenth = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 10);
  std::nth_element(heights.begin(), tenth, heights.end());
  return *tenth;
}

std::vector<Described> describe_frames(const std::vector<Drive>& drives, std::size_t count) {
  std::size_t frames = 0;
  for (const Drive& drive : drives) {
    frames += drive.size();
  }
  const std::size_t spacing = std::max<std::size_t>(1, frames / std::max<std::size_t>(1, count * kFramesPerPair));
  std::vector<Described> described;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    for (std::size_t p = 0; p < drives[d].size(); p += spacing) {
      described.push_back({d, p, {}});
    }
  }
  parallel_for(described.size(), [&](std::size_t i) {
    check_interrupt();
    described[i].descriptor = ring_descriptor(drives[described[i].drive].load(described[i].place).points);
  });
  return described;
}

float distance(const std::vector<float>& a, const std::vector<float>& b) {
  float sum = 0.0F;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return sum;
}

bool far_apart(const Described& a, const Described& b, const std::vector<Drive>& drives, bool one_world,
               double least_m) {
  return (a.drive == b.drive || one_world) &&
         (drives[a.drive].T_world_cloud[a.place].translation() - drives[b.drive].T_world_cloud[b.place].translation())
                 .norm() >= least_m;
}

using Likeness = std::tuple<float, std::size_t, std::size_t>;  // distance, first, second

/// The frame most like each frame, most alike pairs first.
std::vector<Likeness> most_alike(const std::vector<Described>& frames, const std::vector<Drive>& drives, bool one_world,
                                 double least_m) {
  std::vector<Likeness> best(frames.size(), {-1.0F, 0, 0});
  parallel_for(frames.size(), [&](std::size_t i) {
    for (std::size_t j = 0; j < frames.size(); ++j) {
      if (j == i || !far_apart(frames[i], frames[j], drives, one_world, least_m)) {
        continue;
      }
      const Likeness likeness{distance(frames[i].descriptor, frames[j].descriptor), i, j};
      if (std::get<0>(best[i]) < 0.0F || likeness < best[i]) {
        best[i] = likeness;
      }
    }
  });
  std::erase_if(best, [](const Likeness& likeness) { return std::get<0>(likeness) < 0.0F; });
  std::sort(best.begin(), best.end());
  return best;
}

}  // namespace

std::vector<float> ring_descriptor(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> descriptor(2 * kRings, 0.0F);
  if (points.empty()) {
    return descriptor;
  }
  const float ground = ground_level(points);
  std::array<std::array<float, kSectors>, kRings> highest{};
  for (const Eigen::Vector3f& point : points) {
    const double range = std::hypot(point.x(), point.y());
    const int ring = static_cast<int>(range / kReachM * kRings);
    const double turn = (std::atan2(point.y(), point.x()) / std::numbers::pi + 1.0) / 2.0;
    const int sector = std::min(static_cast<int>(turn * kSectors), kSectors - 1);
    if (ring < kRings) {
      float& cell = highest[static_cast<std::size_t>(ring)][static_cast<std::size_t>(sector)];
      cell = std::max(cell, point.z() - ground);
    }
  }
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    const Eigen::Map<const Eigen::Array<float, kSectors, 1>> heights(highest[ring].data());
    descriptor[ring] = heights.mean();
    descriptor[kRings + ring] = std::sqrt((heights - heights.mean()).square().mean());
  }
  return descriptor;
}

std::vector<PairKey> find_hard_negatives(const std::vector<Drive>& drives, std::size_t count, bool one_world,
                                         const BalanceOptions& options) {
  const std::vector<Described> frames = describe_frames(drives, count);
  std::vector<PairKey> negatives;
  std::set<std::size_t> used;
  PoolCost cost;
  for (const auto& [likeness, first, second] : most_alike(frames, drives, one_world, options.negative_distance_m)) {
    if (negatives.size() == count) {
      break;
    }
    if (used.count(first) > 0 || used.count(second) > 0) {
      continue;
    }
    const Drive& source = drives[frames[first].drive];
    const Drive& target = drives[frames[second].drive];
    if (internal::OverlapProbe(source, frames[first].place, cost).with(target, frames[second].place).source > 0.0) {
      continue;
    }
    used.insert({first, second});
    negatives.push_back(
        {source.session, source.frames[frames[first].place], target.frames[frames[second].place], target.session});
  }
  std::sort(negatives.begin(), negatives.end());
  return negatives;
}

}  // namespace loopmark::pair_sets
