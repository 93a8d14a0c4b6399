// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/trajectory.hpp"

#include <gmock/gmock.h>

#include "io/io_fixtures.hpp"
#include "loopmark/core/error.hpp"

namespace loopmark::io {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;

std::vector<Pose> some_poses() {
  Rng rng(3);
  std::vector<Pose> poses;
  for (int i = 0; i < 20; ++i) {
    Vector6d xi;
    for (int k = 0; k < 6; ++k) {
      xi[k] = rng.uniform(-2.0, 2.0) * (k < 3 ? 100.0 : 1.0);
    }
    poses.push_back(exp_se3(xi));
  }
  return poses;
}

std::vector<double> some_stamps() {
  std::vector<double> stamps;
  for (int i = 0; i < 20; ++i) {
    stamps.push_back(1600000000.0 + 0.1 * i);
  }
  return stamps;
}

TEST(Trajectory, BothFormatsComeBack) {
  const TemporaryFolder folder;
  write_tum(folder / "a.tum", some_stamps(), some_poses());
  write_kitti(folder / "a.kitti", some_poses());
  const Trajectory tum = read_trajectory(folder / "a.tum");
  const Trajectory kitti = read_trajectory(folder / "a.kitti");
  ASSERT_EQ(tum.poses.size(), 20U);
  ASSERT_EQ(kitti.poses.size(), 20U);
  EXPECT_TRUE(kitti.stamps_s.empty());
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(tum.stamps_s[i], some_stamps()[i], 1e-6);
    EXPECT_LT((tum.poses[i].matrix() - some_poses()[i].matrix()).norm(), 1e-6);
    EXPECT_LT((kitti.poses[i].matrix() - some_poses()[i].matrix()).norm(), 1e-6);
  }
}

TEST(Trajectory, TumLinesAreAsOthersReadThem) {
  EXPECT_EQ(tum_text({1.5}, {pose_from_yaw(0.0, {1, 2, 3})}),
            "1.500000 1.000000000 2.000000000 3.000000000 0.000000000 0.000000000 0.000000000 1.000000000\n");
}

TEST(Trajectory, PosesBetweenStampsAreInterpolated) {
  const Trajectory trajectory{{1.0, 2.0}, {pose_from_yaw(0.0, {0, 0, 0}), pose_from_yaw(0.0, {10, 0, 0})}};
  EXPECT_NEAR(pose_at(trajectory, 1.25).translation().x(), 2.5, 1e-9);
  EXPECT_NEAR(pose_at(trajectory, 0.0).translation().x(), 0.0, 1e-9);
  EXPECT_NEAR(pose_at(trajectory, 9.0).translation().x(), 10.0, 1e-9);
}

TEST(Trajectory, PosesAreJoinedToScansByTime) {
  const Trajectory in_order{some_stamps(), some_poses()};
  Trajectory backwards;
  backwards.stamps_s.assign(in_order.stamps_s.rbegin(), in_order.stamps_s.rend());
  backwards.poses.assign(in_order.poses.rbegin(), in_order.poses.rend());
  const std::vector<double> scans = {in_order.stamps_s[3], in_order.stamps_s[7] + 0.05};
  const std::vector<Pose> poses = poses_of_scans(backwards, scans, "a.tum");
  EXPECT_LT((poses[0].matrix() - in_order.poses[3].matrix()).norm(), 1e-9);
  EXPECT_LT((poses[1].matrix() - interpolate(in_order.poses[7], in_order.poses[8], 0.5).matrix()).norm(), 1e-2);
  const std::vector<double> later = {in_order.stamps_s[3], in_order.stamps_s[7] + 86400.0};
  EXPECT_THAT(message_of<InputError>([&] { poses_of_scans(in_order, later, "a.tum"); }), HasSubstr("only 1 of 2 scans"));
  EXPECT_THAT(message_of<InputError>([&] { poses_of_scans({}, scans, "empty.tum"); }), HasSubstr("holds no pose"));
  EXPECT_THAT(message_of<InputError>([&] { poses_of_scans({{}, some_poses()}, scans, "a.kitti"); }), HasSubstr("20 poses for 2"));
}

TEST(Trajectory, WrongLinesAreNamed) {
  const TemporaryFolder folder;
  const auto problem = [&](const char* content) {
    folder.write("a.txt", content);
    return message_of<InputError>([&] { read_trajectory(folder / "a.txt"); });
  };
  EXPECT_THAT(problem("# stamp x\n\n1 0 0 0 1 0 0 0 1\n"), HasSubstr("a.txt:3"));
  EXPECT_THAT(problem("1 0 0 0 0 1 0 0 0 0 1 nan\n"), HasSubstr("no finite number"));
  EXPECT_THAT(problem("1 0 0 0 0 1 0 0 0 0 5 0\n"), HasSubstr("rigid"));
  EXPECT_THAT(problem("0 1 2 3 0 0 0 0\n"), HasSubstr("quaternion"));
  EXPECT_THAT(problem("0 1 2 3 0 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 0\n"), HasSubstr("another number"));
  EXPECT_THROW(read_trajectory(folder / "missing.txt"), InputError);
}

}  // namespace
}  // namespace loopmark::io
