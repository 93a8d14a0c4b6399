// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

namespace loopmark {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// What a phase prints that lasts so long.
std::string printed(int milliseconds, const std::function<void(Progress&)>& work) {
  testing::internal::CaptureStderr();
  {
    Progress progress("outer phase", "scans", 10);
    work(progress);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  }
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, AShortPhaseIsSilent) {
  EXPECT_THAT(printed(0, [](Progress& progress) { progress.add(10); }), IsEmpty());
}

TEST(Progress, ALongPhaseIsNamedWithRateAndTimeLeftThoughNoUnitEnds) {
  const std::string text = printed(2000, [](Progress& progress) { progress.add(4, "a note"); });
  EXPECT_THAT(text,
              AllOf(HasSubstr("outer phase 4/10 scans"), HasSubstr("/s"), HasSubstr("left 0:"), HasSubstr("a note")));
}

TEST(Progress, OfPhasesWithinPhasesTheInnermostIsShown) {
  const std::string text = printed(0, [](Progress&) {
    const Progress inner("inner phase");
    std::this_thread::sleep_for(std::chrono::milliseconds(2000));
  });
  EXPECT_THAT(text, AllOf(HasSubstr("inner phase  0:0"), Not(HasSubstr("outer phase"))));
}

TEST(Progress, NothingIsPrintedWhereItIsOff) {
  Progress::set_enabled(false);
  const std::string text = printed(2000, [](Progress& progress) { progress.add(); });
  Progress::set_enabled(true);
  EXPECT_THAT(text, IsEmpty());
}

}  // namespace
}  // namespace loopmark
