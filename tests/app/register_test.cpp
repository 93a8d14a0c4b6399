// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What loopmark register says of two scans.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "loopmark/io/point_files.hpp"
#include "loopmark/registration/evidence_text.hpp"
#include "loopmark/workflows/register_run.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::ProgramResult;
using testing_support::run_program;

const char* const kSource = LOOPMARK_SOURCE_DIR "/maps/demo-query/velodyne/000000.bin";
const char* const kTarget = LOOPMARK_SOURCE_DIR "/maps/demo-query/velodyne/000003.bin";

TEST(Register, EveryNameOfTheEvidenceIsExplained) {
  workflows::RegisterRun run;
  run.source = io::read_point_file(kSource).cloud;
  run.target = io::read_point_file(kTarget).cloud;
  workflows::run_registration(run, workflows::ProgramOptions());
  ASSERT_FALSE(run.result.modes.empty());
  const registration::Evidence& evidence = run.result.modes.front().evidence;
  const auto& names = registration::evidence_names();
  ASSERT_EQ(evidence.size(), names.size());
  const std::string table = registration::evidence_table(run.result.modes, 3);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(evidence[i].first, names[i].name);
    EXPECT_THAT(table, HasSubstr(names[i].meaning));
  }
}

TEST(Register, AnUnknownAnswerDoesNotLookLikeOne) {
  const ProgramResult answered = run_program({"register", kSource, kTarget});
  EXPECT_EQ(answered.exit_code, 0);
  EXPECT_THAT(answered.output, AllOf(HasSubstr("T_target_source of"), HasSubstr("verdict       answered, P(correct)")));
  const std::vector<std::string> strict = {"register", kSource, kTarget, "--set", "registration.min_p_correct=1"};
  const ProgramResult unknown = run_program(strict);
  EXPECT_EQ(unknown.exit_code, 0);
  EXPECT_THAT(unknown.output, AllOf(HasSubstr("UNKNOWN: where "), HasSubstr("reason "), HasSubstr("best guess"),
                                    Not(HasSubstr("T_target_source")), Not(HasSubstr("roll pitch yaw"))));
  std::vector<std::string> json = strict;
  json.insert(json.end(), {"--json", "--quiet"});
  EXPECT_THAT(run_program(json).output, HasSubstr("\"T_target_source\": null"));
}

TEST(Register, AWithheldAnswerIsReplayedFromItsRecord) {
  const std::string record = testing::TempDir() + "loopmark_register_test_record";
  std::filesystem::remove_all(record);
  ASSERT_EQ(run_program({"register", kSource, kTarget, "--set", "registration.min_p_correct=1", "--record", record})
                .exit_code,
            0);
  const ProgramResult replayed = run_program({"replay", record});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.output;
  EXPECT_THAT(replayed.output, HasSubstr("the answer moved by 0.0000 m"));
  std::filesystem::remove_all(record);
}

}  // namespace
}  // namespace loopmark::app
