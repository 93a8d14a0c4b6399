// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/matching/filters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "loopmark/core/random.hpp"

namespace loopmark::matching {
namespace {

struct World {
  std::vector<Eigen::Vector3f> source;
  Correspondences matches;
};

/// Matches crowded in the middle of the source; ratios have few values, so that ties are common.
World random_world(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  World world;
  for (std::size_t i = 0; i < count; ++i) {
    world.source.push_back(
        Eigen::Vector3d(20 * rng.normal() * rng.uniform(), 30 * rng.normal(), rng.normal()).cast<float>());
    if (rng.uniform() < 0.8) {
      Correspondence match;
      match.source = static_cast<std::uint32_t>(i);
      match.target = rng.below(1000);
      match.ratio = static_cast<float>(rng.below(20)) / 20.0F;
      match.mutual = rng.uniform() < 0.3;
      world.matches.push_back(match);
    }
  }
  return world;
}

std::set<std::uint32_t> sources_of(const Correspondences& matches) {
  std::set<std::uint32_t> sources;
  for (const Correspondence& match : matches) {
    sources.insert(match.source);
  }
  return sources;
}

/// GPF by its definition: every level is tried, every cell is sorted.
std::set<std::uint32_t> brute_force_gpf(const World& world, double phi, int cells) {
  double low[2] = {1e9, 1e9};
  double high[2] = {-1e9, -1e9};
  for (const Correspondence& m : world.matches) {
    for (int a = 0; a < 2; ++a) {
      low[a] = std::min(low[a], static_cast<double>(world.source[m.source][a]));
      high[a] = std::max(high[a], static_cast<double>(world.source[m.source][a]));
    }
  }
  std::map<std::pair<int, int>, Correspondences> grid;
  double mutual = 0;
  for (const Correspondence& m : world.matches) {
    int at[2];
    for (int a = 0; a < 2; ++a) {
      const double unit = (static_cast<double>(world.source[m.source][a]) - low[a]) / (high[a] - low[a]);
      at[a] = std::min(cells - 1, static_cast<int>(std::floor(unit * cells)));
    }
    grid[{at[0], at[1]}].push_back(m);
    mutual += m.mutual ? 1 : 0;
  }
  std::size_t best_level = 0;
  double best_miss = 1e18;
  for (std::size_t level = 0; level <= world.matches.size(); ++level) {
    std::size_t sum = 0;
    std::size_t highest = 0;
    for (const auto& [cell, matches] : grid) {
      sum += std::min(level, matches.size());
      highest = std::max(highest, matches.size());
    }
    const double miss = std::abs(static_cast<double>(sum) - phi * mutual);
    if (miss <= best_miss && level <= highest) {
      best_miss = miss;
      best_level = level;
    }
  }
  std::set<std::uint32_t> kept;
  for (auto& [cell, matches] : grid) {
    std::stable_sort(matches.begin(), matches.end(), [](const Correspondence& a, const Correspondence& b) {
      return a.mutual != b.mutual ? a.mutual : a.ratio < b.ratio;
    });
    for (std::size_t k = 0; k < std::min(best_level, matches.size()); ++k) {
      kept.insert(matches[k].source);
    }
  }
  return kept;
}

TEST(Gpf, IsTheBruteForceSelection) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const World world = random_world(400, seed);
    for (const double phi : {0.3, 1.0, 2.0, 3.0, 50.0}) {
      for (const std::size_t cells : {1U, 3U, 10U}) {
        GpfOptions options;
        options.phi = phi;
        options.cells = cells;
        const Correspondences kept = grid_prioritized_filter(world.matches, world.source, options);
        EXPECT_EQ(sources_of(kept), brute_force_gpf(world, phi, static_cast<int>(cells)));
        EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(), better));
      }
    }
  }
}

TEST(Gpf, DoesNotDependOnTheOrderOfTheMatches) {
  World world = random_world(300, 3);
  const auto before = sources_of(grid_prioritized_filter(world.matches, world.source, {}));
  std::reverse(world.matches.begin(), world.matches.end());
  EXPECT_EQ(before, sources_of(grid_prioritized_filter(world.matches, world.source, {})));
}

TEST(Gpf, KeepsEverythingWhenAskedForMoreThanThereIs) {
  const World world = random_world(200, 4);
  GpfOptions options;
  options.phi = 1000.0;
  EXPECT_EQ(grid_prioritized_filter(world.matches, world.source, options).size(), world.matches.size());
  options.max_matches = 50;
  options.cells = 2;
  EXPECT_NEAR(static_cast<double>(grid_prioritized_filter(world.matches, world.source, options).size()), 50.0, 2.0);
}

TEST(Gpf, TakesDegenerateInput) {
  EXPECT_TRUE(grid_prioritized_filter({}, {}, {}).empty());
  Correspondence match;
  match.mutual = true;
  EXPECT_EQ(grid_prioritized_filter({match}, {{1, 2, 3}}, {}).size(), 1U);
  EXPECT_THROW(grid_prioritized_filter({match}, {}, {}), std::invalid_argument);
  GpfOptions options;
  options.cells = 0;
  EXPECT_THROW(grid_prioritized_filter({}, {}, options), InputError);
}

TEST(Gpf, WaterLevelIsTheLargestOfTheClosest) {
  EXPECT_EQ(water_level({5, 5, 5}, 7.0), 2U);  // sums 3, 6, 9: 6 is closest
  EXPECT_EQ(water_level({5, 5, 5}, 7.5), 3U);  // 6 and 9 are as close: the larger
  EXPECT_EQ(water_level({2, 10}, 8.0), 6U);    // 2 + 6
  EXPECT_EQ(water_level({2, 2}, 100.0), 2U);
  EXPECT_EQ(water_level({}, 3.0), 0U);
}

TEST(Filters, MutualAndRatioFollowTheirDefinition) {
  TwoWayNearest nearest;
  nearest.forward = {{1, 0, 1.0F, 4.0F}, {0, 1, 9.0F, 9.0F}, {}};
  nearest.backward = {{0, 1, 1.0F, 2.0F}, {0, 1, 1.0F, 2.0F}};
  const Correspondences matches = correspondences_of(nearest);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_FLOAT_EQ(matches[0].ratio, 0.5F);
  EXPECT_FLOAT_EQ(matches[0].distance, 1.0F);
  EXPECT_TRUE(matches[0].mutual);
  EXPECT_FALSE(matches[1].mutual);
  EXPECT_EQ(keep_mutual(matches).size(), 1U);
  EXPECT_EQ(keep_ratio(matches, 0.8).size(), 1U);
  EXPECT_EQ(keep_best(matches, 1)[0].source, 0U);
  EXPECT_EQ(keep_best(matches, 0).size(), 2U);
}

}  // namespace
}  // namespace loopmark::matching
