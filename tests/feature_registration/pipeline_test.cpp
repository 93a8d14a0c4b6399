// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/feature_registration/pipeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"

namespace loopmark::feature_registration {
namespace {

/// Two samples of a yard with walls, boxes and poles of different sizes, the second moved.
struct Yard {
  PointCloud source, target;
  Pose T_target_source = pose_from_yaw(0.8, {4.0, -3.0, 0.1});
};

void add_box(PointCloud& cloud, const Eigen::Vector3d& corner, const Eigen::Vector3d& size, std::size_t count,
             Rng& rng) {
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d u(rng.uniform(), rng.uniform(), rng.uniform());
    const auto face = rng.below(5);
    u[face % 2 == 0 && face < 4 ? 0 : (face < 4 ? 1 : 2)] = face < 2 ? 0.0 : 1.0;
    cloud.points.push_back((corner + u.cwiseProduct(size)).cast<float>());
  }
}

PointCloud sample_yard(std::uint64_t seed) {
  Rng rng(seed);
  PointCloud cloud;
  for (int i = 0; i < 7000; ++i) {
    cloud.points.push_back(Eigen::Vector3d(rng.uniform(-25, 25), rng.uniform(-25, 25), -1.7).cast<float>());
  }
  Rng shapes(5);  // the same yard for every sample
  for (int k = 0; k < 14; ++k) {
    const Eigen::Vector3d corner(shapes.uniform(-22, 18), shapes.uniform(-22, 18), -1.7);
    const Eigen::Vector3d size(shapes.uniform(0.3, 6), shapes.uniform(0.3, 6), shapes.uniform(1, 5));
    add_box(cloud, corner, size, 1200, rng);
  }
  return cloud;
}

Yard make_yard() {
  Yard yard;
  yard.target = sample_yard(1);
  yard.source = transformed(sample_yard(2), yard.T_target_source.inverse());
  return yard;
}

class PaperPipeline : public testing::TestWithParam<const char*> {};

TEST_P(PaperPipeline, RegistersTwoSamplesOfAYard) {
  const Yard yard = make_yard();
  FeatureRegistrationOptions options = named_algorithm(GetParam());
  options.ransac.max_iterations = std::min<std::size_t>(options.ransac.max_iterations, 50'000);
  const FeatureRegistrationResult result = register_features(yard.source, yard.target, options);
  const PoseError error = pose_error(result.T_target_source, yard.T_target_source);
  EXPECT_TRUE(result.found);
  EXPECT_LT(error.translation_m, 0.2) << result.estimate.summary();
  EXPECT_LT(error.rotation_deg, 1.0) << result.estimate.summary();
  EXPECT_GT(result.matches, result.mutual_matches);
  EXPECT_EQ(result.used.size(), result.used_matches);
  EXPECT_GT(result.algorithm_seconds(), 0.0);
  EXPECT_GT(result.with_refinement_seconds(), result.algorithm_seconds());
  EXPECT_GT(result.all_seconds(), result.with_refinement_seconds());
}

INSTANTIATE_TEST_SUITE_P(Named, PaperPipeline,
                         testing::Values("ransac_gpf", "ransac_mutual", "ransac_mutual_no_ground", "gnc_clique",
                                         "gnc_core", "sc2", "gcransac", "ransac_uniform"));

TEST(PaperPipelineSteps, SameBytesAtAnyNumberOfThreads) {
  const Yard yard = make_yard();
  const FeatureRegistrationOptions options = named_algorithm("ransac_gpf");
  set_thread_count(1);
  const Pose one = register_features(yard.source, yard.target, options).T_target_source;
  set_thread_count(4);
  const Pose four = register_features(yard.source, yard.target, options).T_target_source;
  set_thread_count(0);
  EXPECT_EQ(one.matrix(), four.matrix());
}

TEST(PaperPipelineSteps, DescriptorsMayComeFromElsewhere) {
  const Yard yard = make_yard();
  FeatureRegistrationOptions options = named_algorithm("ransac_mutual");
  options.descriptor = "fpfh";  // keypoints on the surface: they serve the refinement
  const DescribedScan own_source = describe_scan(yard.source, options);
  const DescribedScan own_target = describe_scan(yard.target, options);
  const DescribedScan source = described_scan(own_source.keypoints, own_source.descriptors, yard.source, options);
  const DescribedScan target = described_scan(own_target.keypoints, own_target.descriptors, {}, options);
  const FeatureRegistrationResult result = register_described(source, target, options);
  EXPECT_LT(pose_error(result.T_target_source, yard.T_target_source).translation_m, 0.2);
  EXPECT_THROW(described_scan(own_source.keypoints, own_target.descriptors, {}, options), std::invalid_argument);
}

TEST(PaperPipelineSteps, EmptyScansAreNoAnswer) {
  const FeatureRegistrationResult result = register_features({}, {}, {});
  EXPECT_FALSE(result.found);
  EXPECT_EQ(result.estimate.stop, estimation::EstimateStop::kTooFewMatches);
  PointCloud broken;
  broken.points.assign(10, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE(register_features(broken, broken, {}).found);
}

TEST(NamedAlgorithms, HaveDifferentNamesAndOptionsThatMakeSense) {
  std::set<std::string> names;
  for (const NamedAlgorithm& algorithm : named_algorithms()) {
    EXPECT_TRUE(names.insert(algorithm.name).second);
    EXPECT_NO_THROW(check(algorithm.options));
  }
  EXPECT_THROW(named_algorithm("ransack"), InputError);
}

}  // namespace
}  // namespace loopmark::feature_registration
