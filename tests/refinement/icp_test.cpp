// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/refinement/icp.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "loopmark/core/parallel.hpp"
#include "small_world.hpp"

namespace loopmark::refinement {
namespace {

using testing_support::corridor;
using testing_support::moved;
using testing_support::sample;
using testing_support::small_motion;
using testing_support::yard;

struct Variant {
  const char* name;
  IcpMetric metric;
  IcpPairing pairing;
  least_squares::RobustKernel kernel;
  double accuracy_m;
};

class IcpVariants : public testing::TestWithParam<Variant> {
 protected:
  static IcpOptions options() {
    IcpOptions o;
    o.metric = GetParam().metric;
    o.pairing = GetParam().pairing;
    o.kernel = GetParam().kernel;
    o.max_iterations = 100;
    return o;
  }
};

TEST_P(IcpVariants, FindsTheMotionBetweenTwoSamplesOfAYard) {
  const Surface target = sample(yard(), 12000, 0.01, 1);
  const Pose truth = pose_from_yaw(0.6, {2.0, -1.0, 0.3});  // T_target_source
  const Surface source = moved(sample(yard(), 8000, 0.01, 2), truth.inverse());
  const IcpTarget prepared(target, options().max_distance_m);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const IcpResult result = icp(source, prepared, truth * small_motion(0.25, 1.5, 10 + seed), options());
    const PoseError error = pose_error(result.T_target_source, truth);
    EXPECT_TRUE(result.converged) << result.summary();
    EXPECT_LT(error.translation_m, GetParam().accuracy_m) << result.summary();
    EXPECT_LT(error.rotation_deg, 0.3);
    EXPECT_EQ(result.weak_directions, 0);
  }
}

TEST_P(IcpVariants, MovesWithItsInputs) {
  const Surface target = sample(yard(), 6000, 0.0, 3);
  const Surface source = sample(yard(), 4000, 0.0, 4);
  const Pose initial = small_motion(0.1, 0.5, 5);
  IcpOptions o = options();
  o.stop_translation_m = 1e-6;
  o.stop_rotation_deg = 1e-5;
  const Pose plain = icp(source, IcpTarget(target, 0.6), initial, o).T_target_source;
  const Pose A = pose_from_yaw(2.0, {3, 4, -1});
  const Pose B = small_motion(3.0, 40.0, 6);
  const Pose both =
      icp(moved(source, B), IcpTarget(moved(target, A), 0.6), A * initial * B.inverse(), o).T_target_source;
  const PoseError error = pose_error(both, A * plain * B.inverse());
  EXPECT_LT(error.translation_m, 2e-3);
  EXPECT_LT(error.rotation_deg, 0.02);
}

INSTANTIATE_TEST_SUITE_P(All, IcpVariants,
                         testing::Values(Variant{"PointToPoint", IcpMetric::kPointToPoint, IcpPairing::kNearest,
                                                 least_squares::RobustKernel::kNone, 0.06},
                                         Variant{"PointToPlane", IcpMetric::kPointToPlane, IcpPairing::kNearest,
                                                 least_squares::RobustKernel::kNone, 0.02},
                                         Variant{"PointToPlaneTukey", IcpMetric::kPointToPlane, IcpPairing::kNearest,
                                                 least_squares::RobustKernel::kTukey, 0.01},
                                         Variant{"Symmetric", IcpMetric::kSymmetric, IcpPairing::kNearest,
                                                 least_squares::RobustKernel::kNone, 0.02},
                                         Variant{"SymmetricCauchy", IcpMetric::kSymmetric, IcpPairing::kNearest,
                                                 least_squares::RobustKernel::kCauchy, 0.02},
                                         Variant{"Generalized", IcpMetric::kGeneralized, IcpPairing::kNearest,
                                                 least_squares::RobustKernel::kNone, 0.02},
                                         Variant{"GeneralizedHuber", IcpMetric::kGeneralized, IcpPairing::kNearest,
                                                 least_squares::RobustKernel::kHuber, 0.02},
                                         Variant{"BestBuddies", IcpMetric::kPointToPoint, IcpPairing::kBestBuddies,
                                                 least_squares::RobustKernel::kNone, 0.06},
                                         Variant{"BestBuddiesPlane", IcpMetric::kPointToPlane, IcpPairing::kBestBuddies,
                                                 least_squares::RobustKernel::kNone, 0.02}),
                         [](const auto& variant) { return variant.param.name; });

TEST(Icp, IdenticalCloudsEndExactly) {
  const Surface yard_sample = sample(yard(), 3000, 0.0, 7);
  IcpOptions options;
  options.max_iterations = 200;
  options.stop_translation_m = 1e-8;
  const IcpResult result = icp(yard_sample, IcpTarget(yard_sample, 0.6), small_motion(0.05, 0.2, 8), options);
  EXPECT_LT(log_se3(result.T_target_source).norm(), 1e-5);
  EXPECT_EQ(result.inliers, yard_sample.points.size());
  EXPECT_LT(result.rms_m, 1e-5);
}

TEST(Icp, ForwardAndBackwardAgree) {
  const Surface a = sample(yard(), 8000, 0.01, 9);
  const Surface b = sample(yard(), 8000, 0.01, 10);
  IcpOptions options;
  options.metric = IcpMetric::kPointToPlane;
  const Pose there = icp(a, IcpTarget(b, 0.6), small_motion(0.1, 1.0, 11), options).T_target_source;
  const Pose back = icp(b, IcpTarget(a, 0.6), small_motion(0.1, 1.0, 12), options).T_target_source;
  EXPECT_LT(pose_error(there * back, Pose::Identity()).translation_m, 0.02);
}

TEST(Icp, ReportsTheFreeDirectionOfAStreet) {
  const Surface a = sample(corridor(), 5000, 0.01, 13);
  const Surface b = sample(corridor(), 5000, 0.01, 14);
  IcpOptions options;
  options.metric = IcpMetric::kPointToPlane;
  const IcpResult result = icp(a, IcpTarget(b, 0.6), Pose::Identity(), options);
  EXPECT_EQ(result.weak_directions, 1);
  EXPECT_GT(std::abs(result.constraint.directions(0, 0)), 0.99);
  EXPECT_GT(std::sqrt(result.covariance(0, 0)), 20.0 * std::sqrt(result.covariance(1, 1)));
}

// The truth lies in the ellipsoid of the covariance as often as it should: the mean of xi^T P^-1 xi is 6.
TEST(Icp, CovarianceAgreesWithMonteCarlo) {
  constexpr int kTrials = 150;
  const Surface target = sample(yard(), 20000, 0.0, 15);
  const IcpTarget prepared(target, 0.6);
  IcpOptions options;
  options.metric = IcpMetric::kPointToPlane;
  options.noise_floor_m = 1e-4;
  double sum = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Surface source = sample(yard(), 1500, 0.03, 100 + static_cast<std::uint64_t>(trial));
    const IcpResult result = icp(source, prepared, Pose::Identity(), options);
    const Vector6d xi = log_se3(result.T_target_source);
    sum += xi.dot(result.information * xi);
  }
  EXPECT_GT(sum / kTrials, 6.0 * 0.7);
  EXPECT_LT(sum / kTrials, 6.0 * 1.5);
}

TEST(Icp, SaysWhyItStopped) {
  const Surface a = sample(yard(), 500, 0.0, 16);
  Pose far = Pose::Identity();
  far.translation().x() = 1000.0;
  const IcpResult lost = icp(a, IcpTarget(a, 0.6), far);
  EXPECT_EQ(lost.stop, IcpStop::kTooFewPairs);
  EXPECT_FALSE(lost.converged);
  EXPECT_GT(std::sqrt(lost.covariance(0, 0)), 1.0);
  IcpOptions one;
  one.max_iterations = 1;
  EXPECT_EQ(icp(a, IcpTarget(a, 0.6), small_motion(0.2, 1.0, 17), one).stop, IcpStop::kIterationLimit);
}

TEST(Icp, RefusesMetricsWithoutTheirNormals) {
  Surface bare = sample(yard(), 100, 0.0, 18);
  bare.normals.clear();
  IcpOptions options;
  options.metric = IcpMetric::kSymmetric;
  EXPECT_THROW(icp(bare, IcpTarget(bare, 0.6), Pose::Identity(), options), std::invalid_argument);
  options.max_distance_m = 0.0;
  EXPECT_THROW(icp(bare, IcpTarget(bare, 0.6), Pose::Identity(), options), InputError);
}

TEST(Icp, SameBytesAtAnyNumberOfThreads) {
  const Surface target = sample(yard(), 9000, 0.02, 19);
  const Surface source = sample(yard(), 9000, 0.02, 20);
  std::vector<Eigen::Matrix4d> results;
  for (const std::size_t threads : {1U, 2U, 5U}) {
    set_thread_count(threads);
    results.push_back(icp(source, IcpTarget(target, 0.6), small_motion(0.2, 1, 21)).T_target_source.matrix());
  }
  set_thread_count(0);
  EXPECT_EQ(std::memcmp(results[0].data(), results[1].data(), sizeof(double) * 16), 0);
  EXPECT_EQ(std::memcmp(results[0].data(), results[2].data(), sizeof(double) * 16), 0);
}

}  // namespace
}  // namespace loopmark::refinement
