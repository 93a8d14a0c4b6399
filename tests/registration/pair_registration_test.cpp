// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/pair_registration.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "support/box_world.hpp"

namespace loopmark::registration {
namespace {

Pose start() {
  Pose T = Pose::Identity();
  T.translation() << 40.0, 0.0, 1.8;
  return T;
}

/// T_start_later.
Pose motion() {
  Pose T = pose_from_yaw(0.4);
  T.translation() << 2.0, -1.0, 0.0;
  return T;
}

PointCloud seen_from(const Pose& T_world_lidar, std::uint64_t seed) {
  static const testing_support::BoxWorld world = testing_support::street(80.0, 3);
  return testing_support::sweep(world, T_world_lidar, Vector6d::Zero(), 0.01, seed);
}

const PointCloud& scan_at_start() {
  static const PointCloud scan = seen_from(start(), 1);
  return scan;
}

const PointCloud& scan_after_motion() {
  static const PointCloud scan = seen_from(start() * motion(), 2);
  return scan;
}

/// Always says what it is told.
class Oracle : public PairRegistration {
 public:
  explicit Oracle(const Pose& answer, bool answered = true) : answer_(answer), answered_(answered) {}
  const std::string& name() const override { return name_; }
  PreparedCloudPtr prepare(const PointCloud& cloud) const override { return engine_->prepare(cloud); }
  PreparedCloudPtr restore(const std::string& bytes) const override { return engine_->restore(bytes); }
  RegistrationResult align(const PreparedCloud& source, const PreparedCloud& target) const override {
    return verify(source, target, answer_);
  }
  RegistrationResult verify(const PreparedCloud&, const PreparedCloud&, const Pose& T) const override {
    RegistrationResult result;
    result.answered = answered_;
    result.p_correct = 1.0;
    result.T_target_source = T;
    return result;
  }

 private:
  std::string name_ = "oracle";
  Pose answer_;
  bool answered_;
  PairRegistrationPtr engine_ = engine_registration(EngineOptions());
};

TEST(EngineRegistration, IsTheEngine) {
  const PairRegistrationPtr engine = engine_registration({});
  const PreparedCloudPtr source = engine->prepare(scan_after_motion());
  const PreparedCloudPtr target = engine->prepare(scan_at_start());
  const RegistrationResult result = engine->align(*source, *target);
  const RegistrationResult direct =
      register_scans(prepare_scan(scan_after_motion(), {}), prepare_scan(scan_at_start(), {}), {});
  EXPECT_EQ(result.T_target_source.matrix(), direct.T_target_source.matrix());
  EXPECT_EQ(result.p_correct, direct.p_correct);
}

TEST(EngineRegistration, RestoresTheSameFromItsBytes) {
  const PairRegistrationPtr engine = engine_registration({});
  const PreparedCloudPtr source = engine->prepare(scan_after_motion());
  const PreparedCloudPtr again = engine->restore(source->to_bytes());
  EXPECT_EQ(again->to_bytes(), source->to_bytes());
}

TEST(EngineRegistration, NamesTheFileThatIsDamaged) {
  const auto file = std::filesystem::temp_directory_path() / "loopmark_pair_registration_damaged.prepared";
  storage::write_file_atomically(file, engine_registration({})->prepare(scan_at_start())->to_bytes().substr(0, 200));
  try {
    restore_file(*engine_registration({}), file);
    FAIL() << "damaged bytes were restored";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
  }
  std::filesystem::remove(file);
}

TEST(VerifiedRegistration, JudgesWhatTheFinderFinds) {
  const PairRegistrationPtr engine = engine_registration({});
  const PairRegistrationPtr right = verified_registration(std::make_shared<Oracle>(motion()), engine);
  const PreparedCloudPtr source = right->prepare(scan_after_motion());
  const PreparedCloudPtr target = right->prepare(scan_at_start());
  const RegistrationResult judged = right->align(*source, *target);
  const RegistrationResult by_engine =
      engine->verify(*engine->prepare(scan_after_motion()), *engine->prepare(scan_at_start()), motion());
  EXPECT_EQ(judged.p_correct, by_engine.p_correct) << "the verifier's probability, not the finder's";
  EXPECT_EQ(right->name(), "oracle");

  Pose elsewhere = motion();
  elsewhere.translation().x() += 6.0;
  const PairRegistrationPtr wrong = verified_registration(std::make_shared<Oracle>(elsewhere), engine);
  EXPECT_LT(wrong->align(*source, *target).p_correct, judged.p_correct);
}

TEST(VerifiedRegistration, KeepsTheFindersSilence) {
  const PairRegistrationPtr silent =
      verified_registration(std::make_shared<Oracle>(motion(), false), engine_registration({}));
  EXPECT_FALSE(silent->align(*silent->prepare(scan_after_motion()), *silent->prepare(scan_at_start())).answered);
}

TEST(VerifiedRegistration, RestoresBothHalves) {
  const PairRegistrationPtr both = verified_registration(std::make_shared<Oracle>(motion()), engine_registration({}));
  const std::string bytes = both->prepare(scan_at_start())->to_bytes();
  EXPECT_EQ(both->restore(bytes)->to_bytes(), bytes);
  EXPECT_THROW(both->restore(bytes.substr(0, bytes.size() - 3)), InputError);
}

TEST(PairRegistration, RefusesWhatAnotherAlgorithmPrepared) {
  const PairRegistrationPtr engine = engine_registration({});
  const PairRegistrationPtr both = verified_registration(std::make_shared<Oracle>(motion()), engine);
  EXPECT_THROW(both->align(*engine->prepare(scan_at_start()), *engine->prepare(scan_at_start())),
               std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::registration
