// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/engine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::registration {
namespace {

/// A small street: a plane, house fronts with gaps, and poles, seen from `sensor` at 1.8 m with simple occlusion.
class Street {
 public:
  explicit Street(std::uint64_t seed) {
    Rng rng(seed);
    for (int i = 0; i < 60; ++i) {
      const double yaw = rng.uniform() < 0.5 ? 0.0 : std::numbers::pi / 2;
      walls_.push_back({rng.uniform(-60, 60), rng.uniform(-60, 60), yaw, rng.uniform(3, 14), rng.uniform(1.5, 9)});
    }
  }

  /// Beams of a 64-line sensor that meet the ground or the nearest wall.
  PointCloud scan(const Pose& T_world_sensor, std::uint64_t seed) const {
    Rng rng(seed);
    PointCloud cloud;
    for (int line = 0; line < 64; ++line) {
      const double elevation = (-24.0 + 26.0 * line / 63.0) * std::numbers::pi / 180.0;
      for (int step = 0; step < 900; ++step) {
        const double azimuth = 2.0 * std::numbers::pi * step / 900.0;
        const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                   std::sin(elevation));
        const double range = cast(T_world_sensor.translation(), T_world_sensor.linear() * beam);
        if (range < 90.0) {
          cloud.points.emplace_back(((range + 0.02 * rng.normal()) * beam).cast<float>());
        }
      }
    }
    return cloud;
  }

 private:
  struct Wall {
    double x, y, yaw, length, height;
  };

  double cast(const Eigen::Vector3d& from, const Eigen::Vector3d& d) const {
    double range = d.z() < -1e-3 ? -from.z() / d.z() : 1e9;
    for (const Wall& w : walls_) {
      const Eigen::Vector2d along(std::cos(w.yaw), std::sin(w.yaw));
      const Eigen::Vector2d normal(-along.y(), along.x());
      const double slope = normal.dot(d.head<2>());
      if (std::abs(slope) < 1e-9) {
        continue;
      }
      const Eigen::Vector2d offset = Eigen::Vector2d(w.x, w.y) - from.head<2>();
      const double t = normal.dot(offset) / slope;
      const double s = along.dot(t * d.head<2>() - offset);
      const double z = from.z() + t * d.z();
      if (t > 0.5 && t < range && std::abs(s) < 0.5 * w.length && z > 0.0 && z < w.height) {
        range = t;
      }
    }
    return range;
  }

  std::vector<Wall> walls_;
};

Pose standing_at(double x, double y, double yaw_deg, double roll_deg = 0.0, double pitch_deg = 0.0) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation_from_euler_degrees({roll_deg, pitch_deg, yaw_deg});
  pose.translation() = Eigen::Vector3d(x, y, 1.8);
  return pose;
}

class Engine : public testing::Test {
 protected:
  PreparedScan prepared(const Pose& pose, std::uint64_t seed) const {
    return prepare_scan(street_.scan(pose, seed), options_);
  }

  Street street_{5};
  EngineOptions options_;
};

TEST_F(Engine, FindsTheMotionAtAnyYawAndTilt) {
  const Pose a = standing_at(0, 0, 10);
  const PreparedScan target = prepared(a, 1);
  for (const Pose& b : {standing_at(8, 3, -150), standing_at(-12, 6, 95, 6, -5), standing_at(15, -10, 30, -9, 3)}) {
    const RegistrationResult result = register_scans(prepared(b, 2), target, options_);
    const PoseError error = pose_error(result.T_target_source, a.inverse() * b);
    EXPECT_LT(error.translation_m, 0.2);
    EXPECT_LT(error.rotation_deg, 0.5);
    EXPECT_TRUE(result.answered) << result.p_correct;
  }
}

TEST_F(Engine, ForwardAndInverseAgree) {
  const PreparedScan a = prepared(standing_at(0, 0, 0), 1);
  const PreparedScan b = prepared(standing_at(10, 5, 60), 2);
  const Pose forward = register_scans(a, b, options_).T_target_source;
  const Pose backward = register_scans(b, a, options_).T_target_source;
  const PoseError error = pose_error(forward * backward, Pose::Identity());
  EXPECT_LT(error.translation_m, 0.1);
  EXPECT_LT(error.rotation_deg, 0.3);
}

TEST_F(Engine, AbstainsBetweenDifferentStreets) {
  const PreparedScan here = prepared(standing_at(0, 0, 0), 1);
  const PreparedScan there = prepare_scan(Street(99).scan(standing_at(0, 0, 40), 3), options_);
  const RegistrationResult result = register_scans(here, there, options_);
  EXPECT_FALSE(result.answered) << result.p_correct;
  EXPECT_FALSE(result.reason.empty());
}

TEST_F(Engine, AbstainsWhereScansTouchOnlyAtTheirFringe) {
  const PreparedScan here = prepared(standing_at(0, 0, 0), 1);
  for (const std::uint64_t town : {90, 91, 93, 98, 100, 101, 103}) {
    const PreparedScan there = prepare_scan(Street(town).scan(standing_at(0, 0, 40), 3), options_);
    EXPECT_FALSE(register_scans(here, there, options_).answered) << town;
  }
}

TEST_F(Engine, SameBytesAtAnyNumberOfThreads) {
  const PreparedScan a = prepared(standing_at(0, 0, 0), 1);
  const PreparedScan b = prepared(standing_at(9, -4, 130), 2);
  set_thread_count(1);
  const RegistrationResult one = register_scans(a, b, options_);
  set_thread_count(4);
  const RegistrationResult four = register_scans(a, b, options_);
  EXPECT_EQ(one.T_target_source.matrix(), four.T_target_source.matrix());
  EXPECT_EQ(one.p_correct, four.p_correct);
  EXPECT_EQ(one.covariance, four.covariance);
}

TEST_F(Engine, StoredScansGiveTheSameAnswer) {
  const PreparedScan a = prepared(standing_at(0, 0, 0), 1);
  const PreparedScan b = prepared(standing_at(9, -4, 130), 2);
  const std::string bytes = a.to_bytes();
  EXPECT_LT(bytes.size(), 1U << 20U);
  const PreparedScan restored = PreparedScan::from_bytes(bytes);
  EXPECT_EQ(restored.to_bytes(), bytes);
  EXPECT_EQ(register_scans(a, b, options_).T_target_source.matrix(),
            register_scans(restored, b, options_).T_target_source.matrix());
}

TEST_F(Engine, RefusesDamagedBytes) {
  std::string bytes = prepared(standing_at(0, 0, 0), 1).to_bytes();
  EXPECT_THROW(PreparedScan::from_bytes(bytes.substr(0, bytes.size() / 2)), InputError);
  EXPECT_THROW(PreparedScan::from_bytes("nonsense"), InputError);
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_THROW(PreparedScan::from_bytes(bytes), InputError);
}

TEST_F(Engine, AbstainsWithoutStructure) {
  PointCloud empty;
  const RegistrationResult result =
      register_scans(prepare_scan(empty, options_), prepare_scan(empty, options_), options_);
  EXPECT_FALSE(result.answered);
  EXPECT_EQ(result.p_correct, 0.0);
  EXPECT_FALSE(result.reason.empty());
}

TEST_F(Engine, SubmapOfTwoScansIsFoundFromOne) {
  const Pose a = standing_at(0, 0, 0);
  const Pose b = standing_at(6, 2, 20);
  const Pose query = standing_at(12, -4, -100);
  const PreparedScan submap =
      prepare_submap({street_.scan(a, 1), street_.scan(b, 2)}, {Pose::Identity(), a.inverse() * b}, options_);
  const RegistrationResult result = register_scans(prepared(query, 3), submap, options_);
  EXPECT_LT(pose_error(result.T_target_source, a.inverse() * query).translation_m, 0.2);
  EXPECT_TRUE(result.answered);
}

TEST_F(Engine, VerifyTellsRightFromWrong) {
  const Pose a = standing_at(0, 0, 0);
  const Pose b = standing_at(5, 2, 20);
  const PreparedScan source = prepared(b, 1);
  const PreparedScan target = prepared(a, 2);
  EXPECT_TRUE(verify_motion(source, target, a.inverse() * b, options_).answered);
  EXPECT_FALSE(verify_motion(source, target, standing_at(-9, 14, 77), options_).answered);
}

TEST_F(Engine, PreparedScansWithPosesOrSharesThatAreNoneAreRefused) {
  const std::string good = prepared(standing_at(0, 0, 0), 1).to_bytes();
  ASSERT_NO_THROW(PreparedScan::from_bytes(good));
  const auto with_double = [&](std::size_t at, double value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof value);
    const std::uint32_t checksum = storage::crc32(std::string_view(bytes).substr(12));
    std::memcpy(bytes.data() + 8, &checksum, sizeof checksum);
    return bytes;
  };
  ASSERT_NO_THROW(PreparedScan::from_bytes(with_double(12 + 3 * 8, 0.25)));  // x of T_level_sensor
  EXPECT_THROW(PreparedScan::from_bytes(with_double(12, std::nan(""))), InputError);
  EXPECT_THROW(PreparedScan::from_bytes(with_double(12, 2.0)), InputError);
  EXPECT_THROW(PreparedScan::from_bytes(with_double(12 + 3 * 8, 0x1p40)), InputError);
  EXPECT_THROW(PreparedScan::from_bytes(with_double(12 + 12 * 8, -0.5)), InputError);
}

TEST_F(Engine, EachSourceOfHypothesesFindsTheMotionByItself) {
  const Pose a = standing_at(0, 0, 0);
  const Pose b = standing_at(7, -5, 110, 2, -1);
  for (const char* source : {kFeatures, kBev}) {
    EngineOptions alone = options_;
    alone.sources = {source};
    const RegistrationResult result = register_scans(prepared(b, 1), prepared(a, 2), alone);
    EXPECT_LT(pose_error(result.T_target_source, a.inverse() * b).translation_m, 0.2) << source;
    EXPECT_TRUE(result.answered) << source << " " << result.p_correct;
    ASSERT_FALSE(result.modes.empty());
    EXPECT_EQ(result.modes.front().origin, source);
  }
}

TEST_F(Engine, RefusesSourcesThatItDoesNotKnow) {
  EngineOptions wrong = options_;
  wrong.sources = {"sonar"};
  EXPECT_THROW(register_scans(prepared(standing_at(0, 0, 0), 1), prepared(standing_at(1, 0, 0), 2), wrong), InputError);
  wrong.sources.clear();
  EXPECT_THROW(check(wrong), InputError);
}

}  // namespace
}  // namespace loopmark::registration
