// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/feature_registration/descriptor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"
#include "loopmark/feature_registration/pipeline.hpp"

namespace loopmark::feature_registration {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Ground and posts around a sensor 1.7 m above it.
PointCloud posts(std::uint64_t seed) {
  Rng rng(seed);
  PointCloud cloud;
  for (int i = 0; i < 6000; ++i) {
    cloud.points.emplace_back(static_cast<float>(rng.uniform(-30.0, 30.0)),
                              static_cast<float>(rng.uniform(-30.0, 30.0)), -1.7F);
  }
  for (int k = 0; k < 60; ++k) {
    const auto x = static_cast<float>(rng.uniform(-28.0, 28.0));
    const auto y = static_cast<float>(rng.uniform(-28.0, 28.0));
    for (float z = -1.6F; z < 2.0F; z += 0.1F) {
      cloud.points.emplace_back(x, y, z);
      cloud.points.emplace_back(x + 0.4F, y, z);
    }
  }
  return cloud;
}

std::size_t rows_of(const search::DescriptorRows& descriptors) {
  return std::visit([](const auto& m) { return static_cast<std::size_t>(m.rows()); }, descriptors);
}

FeatureRegistrationOptions with(const std::string& descriptor) {
  FeatureRegistrationOptions options;
  options.descriptor = descriptor;
  return options;
}

TEST(Descriptors, HaveDifferentNamesAndTheFirstIsTheDefault) {
  std::set<std::string> names;
  for (const NamedDescriptor& entry : descriptors()) {
    EXPECT_TRUE(names.insert(entry.name).second);
    EXPECT_FALSE(entry.summary.empty());
    EXPECT_NE(make_descriptor(with(entry.name)), nullptr);
  }
  EXPECT_EQ(descriptors().front().name, FeatureRegistrationOptions().descriptor);
  EXPECT_THAT([] { make_descriptor(with("fpfhh")); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("'fpfhh'"), HasSubstr("fsc, fpfh"))));
}

TEST(Descriptors, EachDescribesWhatItSaysAndTheSameAtAnyNumberOfThreads) {
  const PointCloud cloud = posts(1);
  for (const NamedDescriptor& entry : descriptors()) {
    set_thread_count(1);
    const DescribedScan one = describe_scan(cloud, with(entry.name));
    set_thread_count(3);
    const DescribedScan three = describe_scan(cloud, with(entry.name));
    set_thread_count(0);
    EXPECT_GT(one.keypoints.size(), 30U) << entry.name;
    EXPECT_EQ(rows_of(one.descriptors), one.keypoints.size()) << entry.name;
    EXPECT_EQ(one.keypoints, three.keypoints) << entry.name;
    EXPECT_EQ(one.descriptors, three.descriptors) << entry.name;
  }
}

TEST(Descriptors, EachRegistersAScanToItselfMoved) {
  const PointCloud target = posts(2);
  const Pose T = pose_from_yaw(1.1, {3.0, -2.0, 0.0});
  const PointCloud source = transformed(target, T.inverse());
  for (const NamedDescriptor& entry : descriptors()) {
    FeatureRegistrationOptions options = named_algorithm("ransac_gpf");
    options.descriptor = entry.name;
    const FeatureRegistrationResult result = register_features(source, target, options);
    EXPECT_TRUE(result.found) << entry.name;
    EXPECT_LT(pose_error(result.T_target_source, T).translation_m, 0.1) << entry.name;
  }
}

TEST(Descriptors, ThatCannotBeComparedAreToldWithBothNames) {
  const PointCloud cloud = posts(3);
  const DescribedScan one = describe_scan(cloud, with("fsc"));
  const DescribedScan other = describe_scan(cloud, with("fpfh"));
  EXPECT_NO_THROW(require_comparable(one, "a.npz", one, "b.npz"));
  EXPECT_THAT([&] { require_comparable(one, "a.npz", other, "b.npz"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("a.npz"), HasSubstr("b.npz"), HasSubstr("33 numbers"))));
}

}  // namespace
}  // namespace loopmark::feature_registration
