// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/shape_context/fourier_shape_context.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <tuple>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/pose.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/matching/nearest_two.hpp"

namespace loopmark::shape_context {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Trunks of various heights on level ground (z = 0), scattered without order.
Points grove(std::uint64_t seed, int trunks = 300, float half_side = 45.0F) {
  Rng rng(seed);
  Points points;
  for (int t = 0; t < trunks; ++t) {
    const auto x = static_cast<float>(rng.uniform(-half_side, half_side));
    const auto y = static_cast<float>(rng.uniform(-half_side, half_side));
    const auto top = static_cast<float>(rng.uniform(0.8, 7.0));
    for (float z = 0.1F; z < top; z += 0.31F) {
      points.emplace_back(x + static_cast<float>(rng.uniform(-0.05, 0.05)),
                          y + static_cast<float>(rng.uniform(-0.05, 0.05)), z);
    }
  }
  return points;
}

std::vector<float> heights_of(const Points& points) {
  std::vector<float> heights;
  for (const Eigen::Vector3f& p : points) {
    heights.push_back(p.z());
  }
  return heights;
}

Keypoints described(const Points& points, const Options& options = {}) {
  return describe_structure(points, heights_of(points), options);
}

Points moved(Points points, const Pose& T) {
  for (Eigen::Vector3f& p : points) {
    p = T.cast<float>() * p;
  }
  return points;
}

constexpr int kSectors = 36;
constexpr int kRings = 10;
constexpr int kBands = 2;

/// One structure column of the scan: 0.3 m wide, of one band.
struct Column {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double voxels = 0.0;
};

/// Occupied voxels around a place over bands, rings and sectors, as the documentation defines it.
std::vector<double> reference_histogram(const Points& points, const Eigen::Vector3f& at, double radius) {
  std::map<std::tuple<int, int, int>, Column> columns;
  std::set<std::tuple<int, int, int>> voxels;
  for (const Eigen::Vector3f& p : points) {
    const auto cell = [](float x) { return static_cast<int>(std::floor(x * (1.0F / 0.3F))); };
    if (p.z() >= 0.3F && voxels.emplace(cell(p.x()), cell(p.y()), cell(p.z())).second) {
      Column& c = columns[{cell(p.x()), cell(p.y()), p.z() >= 2.0F ? 1 : 0}];
      c.sum += p.head<2>().cast<double>();
      c.voxels += 1.0;
    }
  }
  std::vector<double> bins(kBands * kRings * kSectors, 0.0);
  for (const auto& [key, column] : columns) {
    const double count = column.voxels;
    const Eigen::Vector2d d = column.sum / count - at.head<2>().cast<double>();
    if (d.norm() >= radius) {
      continue;
    }
    const double place = kRings * std::pow(d.norm() / radius, 0.75);
    const double ring = place < 0.5 ? 2.0 * place - 1.0 : place - 0.5;
    const double angle = std::atan2(d.y(), d.x());
    const double sector = (angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle) * kSectors / (2.0 * std::numbers::pi);
    for (int r = static_cast<int>(std::floor(ring)); r <= static_cast<int>(std::floor(ring)) + 1; ++r) {
      for (int s = static_cast<int>(std::floor(sector)); s <= static_cast<int>(std::floor(sector)) + 1; ++s) {
        const double weight = (1.0 - std::abs(ring - r)) * (1.0 - std::abs(sector - s)) * count;
        for (int all = 0; all < kSectors && r < 0; ++all) {
          bins[static_cast<std::size_t>(std::get<2>(key) * kRings * kSectors + all)] += weight / kSectors;
        }
        if (r >= 0 && r < kRings) {
          bins[static_cast<std::size_t>((std::get<2>(key) * kRings + r) * kSectors + s % kSectors)] += weight;
        }
      }
    }
  }
  return bins;
}

/// The descriptor of a place in double precision, by its definition.
std::vector<double> reference_descriptor(const Points& points, const Eigen::Vector3f& at, double radius) {
  const std::vector<double> bins = reference_histogram(points, at, radius);
  std::vector<double> magnitudes;
  std::vector<double> phases;
  const auto signed_root = [](double x) { return std::copysign(std::sqrt(std::abs(x)), x); };
  for (int band = 0; band < kBands; ++band) {
    std::vector<std::complex<double>> inner;
    for (int ring = 0; ring < kRings; ++ring) {
      std::vector<std::complex<double>> c(kSectors / 2 + 1);
      for (int k = 0; k <= kSectors / 2; ++k) {
        for (int s = 0; s < kSectors; ++s) {
          const double count = bins[static_cast<std::size_t>((band * kRings + ring) * kSectors + s)];
          c[static_cast<std::size_t>(k)] +=
              std::sqrt(count) * std::polar(1.0, -2.0 * std::numbers::pi * k * s / kSectors);
        }
        magnitudes.push_back(std::sqrt((k > 0 ? std::sqrt(2.0) : 1.0) * std::abs(c[static_cast<std::size_t>(k)])));
      }
      for (int part = 0; part < 2 && ring > 0; ++part) {
        for (std::size_t k = 1; k < kSectors / 2; ++k) {
          const std::complex<double> g = c[k] * std::conj(inner[k]) / std::sqrt(std::abs(c[k] * inner[k]) + 1e-6);
          phases.push_back(signed_root(part == 0 ? g.real() : g.imag()));
        }
      }
      inner = c;
    }
  }
  magnitudes.insert(magnitudes.end(), phases.begin(), phases.end());
  double squares = 0.0;
  for (const double x : magnitudes) {
    squares += x * x;
  }
  for (double& x : magnitudes) {
    x /= std::sqrt(squares);
  }
  return magnitudes;
}

TEST(FourierShapeContext, IsWhatItsDefinitionSays) {
  const Points points = grove(1);
  const Options options;
  const Keypoints found = described(points, options);
  ASSERT_GT(found.points.size(), 200U);
  double difference = 0.0;
  for (std::size_t i = 0; i < found.points.size(); i += 29) {
    const std::vector<double> expected = reference_descriptor(points, found.points[i], options.radius_m);
    ASSERT_EQ(expected.size(), static_cast<std::size_t>(kDimension));
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const double whole = found.descriptors(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      EXPECT_NEAR(whole, 512.0 * expected[k], 4.0)
          << "keypoint " << i << ", number " << k;  // roots near zero are steep
      difference += std::abs(whole - 512.0 * expected[k]);
    }
  }
  const double compared = std::ceil(static_cast<double>(found.points.size()) / 29.0) * kDimension;
  EXPECT_LT(difference / compared, 0.3);  // rounding alone: 0.25
}

/// Keypoints of the first scan whose mutual nearest neighbour in the second is the same place, over all mutual ones.
double share_right(const Keypoints& a, const Keypoints& b, const Pose& T_b_a) {
  const matching::TwoWayNearest nearest = matching::nearest_two(a.descriptors, b.descriptors);
  double mutual = 0.0;
  double right = 0.0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const std::uint32_t j = nearest.forward[i].first;
    if (j != matching::kNoNeighbour && nearest.backward[j].first == i) {
      mutual += 1.0;
      right += (T_b_a * a.points[i].cast<double>() - b.points[j].cast<double>()).norm() < 0.6 ? 1.0 : 0.0;
    }
  }
  EXPECT_GT(mutual, 0.15 * static_cast<double>(a.points.size()));
  return right / mutual;
}

TEST(FourierShapeContext, FindsTheSamePlacesAgainAtAnyYaw) {
  const Points here = grove(2);
  for (const double yaw : {0.1, 1.3, 2.0, 3.1, -2.2}) {
    const Pose T = pose_from_yaw(yaw, {5.0, -3.0, 0.0});
    EXPECT_GT(share_right(described(here), described(moved(here, T)), T), 0.9) << "yaw " << yaw;
  }
  const Pose still = Pose::Identity();
  EXPECT_LT(share_right(described(here), described(grove(3)), still), 0.1) << "another grove is another place";
}

TEST(FourierShapeContext, TurnsItsDescriptorsByNothingWhenTheSceneTurns) {
  const Points here = grove(4);
  const Options options;
  const double quarter = std::numbers::pi / 2.0;
  const Keypoints a = described(here, options);
  const Keypoints b = described(moved(here, pose_from_yaw(quarter, Eigen::Vector3d::Zero())), options);
  const matching::TwoWayNearest nearest = matching::nearest_two(a.descriptors, b.descriptors);
  std::size_t near = 0;
  for (const matching::NearestTwo& two : nearest.forward) {
    near += two.first_squared < 0.02F * 512.0F * 512.0F ? 1U : 0U;  // cosine above 0.99
  }
  EXPECT_GT(near, a.points.size() * 8 / 10);
}

TEST(FourierShapeContext, GivesTheSameBytesAtAnyNumberOfThreads) {
  const Points points = grove(5);
  set_thread_count(1);
  const Keypoints one = described(points);
  set_thread_count(3);
  const Keypoints three = described(points);
  set_thread_count(0);
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(one.descriptors, three.descriptors);
}

TEST(FourierShapeContext, KeepsTheTallestStructureAndSetsItOnTheGround) {
  Options options;
  options.max_keypoints = 10;
  Points points = grove(6, 100);
  for (int t = 0; t < 10; ++t) {
    for (float z = 0.1F; z < 11.0F; z += 0.3F) {
      points.emplace_back(3.25F + static_cast<float>(t), 2.25F, z);
    }
  }
  const Keypoints found = described(points, options);
  ASSERT_EQ(found.points.size(), 10U);
  for (const Eigen::Vector3f& p : found.points) {
    EXPECT_NEAR(p.y(), 2.25F, 0.3F);
    EXPECT_NEAR(p.z(), 0.0F, 1e-4F);
  }
}

TEST(FourierShapeContext, DescribesNothingWhereNothingStands) {
  EXPECT_TRUE(described({}).points.empty());
  Points ground;
  Rng rng(7);
  for (int i = 0; i < 5000; ++i) {
    ground.emplace_back(static_cast<float>(rng.uniform(-30.0, 30.0)), static_cast<float>(rng.uniform(-30.0, 30.0)),
                        0.0F);
  }
  EXPECT_TRUE(described(ground).points.empty());
  EXPECT_TRUE(describe_scan({}, {}).points.empty());
}

TEST(FourierShapeContext, FindsTheGroundOfATiltedScanByItself) {
  Points points = grove(8);
  for (float x = -30.0F; x < 30.0F; x += 0.4F) {
    for (float y = -30.0F; y < 30.0F; y += 0.4F) {
      points.emplace_back(x, y, 0.0F);
    }
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto seen_from = [&](double yaw, double roll) {
    const Pose T_sensor_level = Pose(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX())) *
                                Pose(Eigen::Translation3d(0.0, 0.0, -1.8)) *
                                pose_from_yaw(yaw, Eigen::Vector3d::Zero());
    return T_sensor_level;
  };
  const Pose T_a = seen_from(0.0, 0.05);
  const Pose T_b = seen_from(2.5, -0.04);
  Points a = moved(points, T_a);
  a.emplace_back(nan, nan, nan);
  const Keypoints first = describe_scan(a, {});
  const Keypoints second = describe_scan(moved(points, T_b), {});
  ASSERT_GT(first.points.size(), 100U);
  EXPECT_GT(share_right(first, second, T_b * T_a.inverse()), 0.8);
}

TEST(FourierShapeContext, RefusesWhatDoesNotFit) {
  EXPECT_THROW(describe_structure({Eigen::Vector3f::Zero()}, {}, {}), std::invalid_argument);
  Options options;
  options.radius_m = 0.0;
  EXPECT_THROW(described({}, options), InputError);
}

}  // namespace
}  // namespace loopmark::shape_context
