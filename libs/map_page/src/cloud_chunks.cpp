// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_chunks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <unordered_set>

#include "loopmark/core/parallel.hpp"
#include "loopmark/web_page/block.hpp"

namespace loopmark::map_page::internal {
namespace {

constexpr double kChunkPath_m = 50.0;        // driven in a chunk
constexpr std::size_t kChunkKeyframes = 60;  // at most, whatever the distance
constexpr std::size_t kSampled = 64;         // keyframes that tell ranges and sizes for all

struct Point {
  Eigen::Vector3f local;   // keyframe's frame
  Eigen::Vector3f in_map;  // relative to the chunk's first keyframe
  std::uint8_t intensity = 0;
  std::uint16_t keyframe = 0;  // from the chunk's first
  std::uint8_t level = 0;
};

std::uint64_t voxel_of(const Eigen::Vector3f& p, double voxel_m) {
  const auto cell = [&](float x) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / voxel_m)) + (1 << 20)) & 0x1fffffU;
  };
  return (cell(p.x()) << 42) | (cell(p.y()) << 21) | cell(p.z());
}

/// Every third bit of a whole number of 21 bits.
std::uint64_t spread(std::uint64_t bits) {
  std::uint64_t result = 0;
  for (int i = 0; i < 21; ++i) {
    result |= ((bits >> i) & 1U) << (3 * i);
  }
  return result;
}

/// Neighbours in space are mostly neighbours in this order (Morton 1966), so that their differences compress.
std::uint64_t morton(const Eigen::Vector3f& p) {
  const std::uint64_t v = voxel_of(p, 0.1);
  return spread(v >> 42) | (spread((v >> 21) & 0x1fffffU) << 1) | (spread(v & 0x1fffffU) << 2);
}

/// From fine to coarse: the points that are the first of their voxel. A point's level is the coarsest it is left at.
void thin(std::vector<Point>& points, std::size_t levels) {
  std::unordered_set<std::uint64_t> taken;
  for (std::size_t level = levels; level-- > 0;) {
    taken.clear();
    std::vector<Point> kept;
    for (Point& p : points) {
      const bool candidate = level + 1 == levels || p.level == level + 1;
      if (candidate && taken.insert(voxel_of(p.in_map, kLevelVoxel_m[level])).second) {
        p.level = static_cast<std::uint8_t>(level);
      } else if (level + 1 == levels) {
        continue;
      }
      kept.push_back(p);
    }
    points.swap(kept);
  }
}

std::vector<Chunk> cut(const mapping::SolvedMap& map) {
  std::vector<Chunk> chunks;
  double begin_m = 0.0;
  for (const mapping::Keyframe& keyframe : map.keyframes) {
    const bool same = !chunks.empty() && chunks.back().keyframes < kChunkKeyframes &&
                      keyframe.path_m - begin_m < kChunkPath_m &&
                      map.keyframes[keyframe.number - 1].segment == keyframe.segment;
    if (!same) {
      chunks.push_back({});
      chunks.back().first = keyframe.number;
      begin_m = keyframe.path_m;
    }
    ++chunks.back().keyframes;
  }
  return chunks;
}

std::vector<Point> points_of(const Chunk& chunk, const mapping::SolvedMap& map, const KeyframeCloud& keyframe_cloud,
                             const std::array<double, 2>& intensity, std::size_t levels) {
  const Pose T_chunk_map = map.T_map_keyframe[chunk.first].inverse();
  const double range = std::max(intensity[1] - intensity[0], 1e-9);
  std::vector<Point> points;
  for (std::size_t k = 0; k < chunk.keyframes; ++k) {
    const PointCloud cloud = keyframe_cloud(chunk.first + k);
    const Eigen::Isometry3f T = (T_chunk_map * map.T_map_keyframe[chunk.first + k]).cast<float>();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      Point p;
      p.local = cloud.points[i];
      p.in_map = T * p.local;
      p.keyframe = static_cast<std::uint16_t>(k);
      if (!cloud.intensity.empty()) {
        // 64 steps: more cannot be told apart, and cost as much as the coordinates.
        const double share = std::clamp((cloud.intensity[i] - intensity[0]) / range, 0.0, 1.0);
        p.intensity = static_cast<std::uint8_t>(4 * static_cast<int>(63.0 * share));
      }
      points.push_back(p);
    }
  }
  thin(points, levels);
  return points;
}

void order(std::vector<Point>& points) {
  std::vector<std::pair<std::uint64_t, std::size_t>> place(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    place[i] = {morton(points[i].local), i};
  }
  std::sort(place.begin(), place.end(), [&](const auto& a, const auto& b) {
    const Point& p = points[a.second];
    const Point& q = points[b.second];
    return std::tie(p.level, p.keyframe, a) < std::tie(q.level, q.keyframe, b);
  });
  std::vector<Point> ordered;
  ordered.reserve(points.size());
  for (const auto& [code, i] : place) {
    ordered.push_back(points[i]);
  }
  points.swap(ordered);
}

void measure(Chunk& chunk, const std::vector<Point>& points, std::size_t levels) {
  chunk.levels.assign(levels, 0);
  float widest = 0.0F;
  for (const Point& p : points) {
    ++chunk.levels[p.level];
    widest = std::max(widest, p.local.cwiseAbs().maxCoeff());
    chunk.reach_m = std::max<double>(chunk.reach_m, p.local.norm());
  }
  for (std::size_t level = 1; level < levels; ++level) {
    chunk.levels[level] += chunk.levels[level - 1];
  }
  chunk.scale_m = std::max<double>(kRounded_m, widest / 32767.0);
}

/// NAME.xyz: all x, all y, all z. NAME.runs: points of each keyframe in each level. NAME.intensity.
std::string blocks_of(const Chunk& chunk, const std::vector<Point>& points, bool with_intensity) {
  const std::string name = "cloud." + std::to_string(chunk.first);
  std::vector<std::int16_t> xyz(3 * points.size());
  std::vector<std::uint32_t> runs(chunk.levels.size() * chunk.keyframes, 0);
  std::vector<std::uint8_t> intensity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      xyz[static_cast<std::size_t>(axis) * points.size() + i] =
          static_cast<std::int16_t>(std::lround(points[i].local[axis] / chunk.scale_m));
    }
    ++runs[points[i].level * chunk.keyframes + points[i].keyframe];
    intensity.push_back(points[i].intensity);
  }
  std::string text = web_page::block(name + ".xyz", xyz) + web_page::block(name + ".runs", runs);
  return with_intensity ? text + web_page::block(name + ".intensity", intensity) : text;
}

std::array<double, 2> percentiles(std::vector<double>& values) {
  if (values.empty()) {
    return {0.0, 0.0};
  }
  std::sort(values.begin(), values.end());
  return {values[values.size() / 50], values[values.size() - 1 - values.size() / 50]};
}

/// Ranges of height and intensity, from keyframes spread over the run.
void measure_ranges(ChunkedCloud& cloud, const mapping::SolvedMap& map, const KeyframeCloud& keyframe_cloud) {
  std::vector<double> heights;
  std::vector<double> intensities;
  const std::size_t every = std::max<std::size_t>(1, map.keyframes.size() / kSampled);
  for (std::size_t k = 0; k < map.keyframes.size(); k += every) {
    const PointCloud points = keyframe_cloud(k);
    for (std::size_t i = 0; i < points.size(); i += 7) {
      heights.push_back((map.T_map_keyframe[k] * points.points[i].cast<double>()).z());
      if (!points.intensity.empty()) {
        intensities.push_back(points.intensity[i]);
      }
    }
  }
  cloud.height_m = percentiles(heights);
  cloud.intensity = percentiles(intensities);
}

/// How many levels fit, and how many points there are at all, from chunks spread over the run.
void measure_levels(ChunkedCloud& cloud, const mapping::SolvedMap& map, const KeyframeCloud& keyframe_cloud,
                    std::size_t max_points) {
  constexpr std::size_t kChunks = 16;
  const std::size_t every = std::max<std::size_t>(1, cloud.chunks.size() / kChunks);
  const std::size_t sampled = (cloud.chunks.size() + every - 1) / every;
  std::vector<std::array<double, kLevelVoxel_m.size()>> counts(sampled);
  parallel_for(sampled, [&](std::size_t i) {
    Chunk chunk = cloud.chunks[i * every];
    measure(chunk, points_of(chunk, map, keyframe_cloud, cloud.intensity, kLevelVoxel_m.size()), kLevelVoxel_m.size());
    for (std::size_t level = 0; level < kLevelVoxel_m.size(); ++level) {
      counts[i][level] = static_cast<double>(chunk.levels[level]) / static_cast<double>(chunk.keyframes);
    }
  });
  const double keyframes =
      static_cast<double>(map.keyframes.size()) / static_cast<double>(std::max<std::size_t>(1, sampled));
  std::array<double, kLevelVoxel_m.size()> all{};
  for (const auto& chunk : counts) {
    for (std::size_t level = 0; level < all.size(); ++level) {
      all[level] += chunk[level] * keyframes;
    }
  }
  cloud.of = static_cast<std::size_t>(all.back());
  while (cloud.levels > 1 && all[cloud.levels - 1] > static_cast<double>(max_points)) {
    --cloud.levels;
  }
}

}  // namespace

ChunkedCloud chunked_cloud(const mapping::SolvedMap& map, const KeyframeCloud& keyframe_cloud, std::size_t max_points) {
  ChunkedCloud cloud;
  cloud.chunks = cut(map);
  measure_ranges(cloud, map, keyframe_cloud);
  measure_levels(cloud, map, keyframe_cloud, max_points);
  const bool with_intensity = cloud.intensity[1] > cloud.intensity[0];
  parallel_for(cloud.chunks.size(), [&](std::size_t i) {
    Chunk& chunk = cloud.chunks[i];
    std::vector<Point> points = points_of(chunk, map, keyframe_cloud, cloud.intensity, cloud.levels);
    order(points);
    measure(chunk, points, cloud.levels);
    chunk.blocks = blocks_of(chunk, points, with_intensity);
  });
  for (const Chunk& chunk : cloud.chunks) {
    cloud.points += chunk.levels.back();
  }
  cloud.of = cloud.levels == kLevelVoxel_m.size() ? cloud.points : std::max(cloud.of, cloud.points);
  return cloud;
}

}  // namespace loopmark::map_page::internal
