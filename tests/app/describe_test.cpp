// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// loopmark describe, and the descriptors of register.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "loopmark/core/random.hpp"
#include "loopmark/features/descriptor_export.hpp"
#include "loopmark/features/descriptor_file.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/storage/files.hpp"
#include "pair_sets/pair_files.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::ProgramResult;
using testing_support::run_program;

/// Posts on level ground, and the same moved.
class DescribeProgram : public testing::Test {
 protected:
  DescribeProgram() {
    Rng rng(2);
    PointCloud target;
    for (int i = 0; i < 6000; ++i) {
      target.points.emplace_back(static_cast<float>(rng.uniform(-30.0, 30.0)),
                                 static_cast<float>(rng.uniform(-30.0, 30.0)), -1.7F);
    }
    for (int k = 0; k < 60; ++k) {
      const auto x = static_cast<float>(rng.uniform(-28.0, 28.0));
      const auto y = static_cast<float>(rng.uniform(-28.0, 28.0));
      for (float z = -1.6F; z < 2.0F; z += 0.1F) {
        target.points.emplace_back(x, y, z);
        target.points.emplace_back(x + 0.4F, y, z);
      }
    }
    io::write_bin(folder_ / "b.bin", target);
    io::write_bin(folder_ / "a.bin", transformed(target, T_.inverse()));
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  ProgramResult registered(const std::string& descriptor) const {
    return run_program(
        {"register", path("a.bin"), path("b.bin"), "--algorithm", "ransac_gpf", "--descriptor", descriptor, "--json"});
  }

  double error_of(const ProgramResult& result) const {
    const auto json = nlohmann::json::parse(result.output);
    const std::vector<double> T = json["T_target_source"];
    return (Eigen::Vector3d(T[3], T[7], T[11]) - T_.translation()).norm();
  }

  test::TemporaryFolder folder_;
  Pose T_ = pose_from_yaw(1.1, {3.0, -2.0, 0.0});
};

TEST_F(DescribeProgram, WritesWhatRegisterReads) {
  const ProgramResult described = run_program({"describe", path("a.bin"), path("b.bin"), "-o", path("features")});
  ASSERT_EQ(described.exit_code, 0) << described.output;
  EXPECT_THAT(described.output, HasSubstr("2 scans described by fsc"));
  EXPECT_GT(features::read_descriptors(path("features/a.npz")).points.size(), 30U);
  const ProgramResult from_files = registered(path("features"));
  const ProgramResult by_name = registered("fsc");
  ASSERT_EQ(from_files.exit_code, 0) << from_files.output;
  ASSERT_EQ(by_name.exit_code, 0) << by_name.output;
  EXPECT_LT(error_of(from_files), 0.1);
  EXPECT_EQ(nlohmann::json::parse(from_files.output)["T_target_source"],
            nlohmann::json::parse(by_name.output)["T_target_source"]);
  const ProgramResult fpfh = registered("fpfh");
  ASSERT_EQ(fpfh.exit_code, 0) << fpfh.output;
  EXPECT_LT(error_of(fpfh), 0.1);
}

TEST_F(DescribeProgram, SaysWhatIsWrong) {
  const ProgramResult unknown = run_program({"describe", path("a.bin"), "--descriptor", "sift", "-o", path("x")});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, HasSubstr("no descriptor is called 'sift'"));
  EXPECT_FALSE(fs::exists(path("x")));
  fs::create_directories(path("other"));
  fs::copy_file(path("b.bin"), path("other/a.bin"));
  const ProgramResult twice = run_program({"describe", path("a.bin"), path("other/a.bin"), "-o", path("x")});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.output, HasSubstr("two scans are called a"));
  EXPECT_THAT(registered("sift").output, HasSubstr("no descriptor is called 'sift'"));
  fs::create_directories(path("empty"));
  const ProgramResult missing = registered(path("empty"));
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.output, HasSubstr("empty/a.npz"));
}

TEST_F(DescribeProgram, DescriptorsOfUnlikeLengthAreAnErrorThatNamesThem) {
  fs::create_directories(path("mixed"));
  const std::vector<Eigen::Vector3f> points(4, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  features::export_descriptors(path("mixed/a.npz"), points,
                               search::DescriptorMatrix(search::DescriptorMatrix::Ones(4, 32)));
  features::export_descriptors(path("mixed/b.npz"), points,
                               search::DescriptorMatrix(search::DescriptorMatrix::Ones(4, 33)));
  const ProgramResult result = registered(path("mixed"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("32 numbers"));
  EXPECT_THAT(result.output, HasSubstr("33 numbers"));
}

}  // namespace
}  // namespace loopmark::app
