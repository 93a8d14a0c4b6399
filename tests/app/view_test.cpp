// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"
#include "loopmark/map_store/loop_decisions.hpp"
#include "loopmark/workflows/view_session.hpp"
#include "synthetic_run.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing_support::SyntheticRun;

class View : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(LOOPMARK_TEST_DATA_DIR) / "view" / test->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    run_.emplace(folder_ / "run");
  }

  /// Two keyframes as the page names them: by their scans.
  std::string pair(std::size_t source, std::size_t target) const {
    return std::to_string(run_->scan_of_keyframe[source]) + "-" + std::to_string(run_->scan_of_keyframe[target]);
  }

  static nlohmann::json data_of(const std::string& html) {
    const std::string begin = "id=\"page-data\">";
    const std::size_t at = html.find(begin) + begin.size();
    return nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
  }

  static std::string block(const std::string& html, const std::string& name) {
    const std::size_t at = html.find("data-name=\"" + name + "\"");
    return html.substr(at, html.find("</script>", at) - at);
  }

  fs::path folder_;
  std::optional<SyntheticRun> run_;
};

TEST_F(View, AVetoSolvesTheMapAgainAndUndoTakesItBack) {
  workflows::ViewSession session(folder_ / "run");
  const std::string before = session.act("loops", "--veto " + pair(39, 0));
  EXPECT_THAT(data_of(before)["message"].get<std::string>(),
              HasSubstr("veto " + pair(39, 0) + ": poses moved by up to"));
  EXPECT_EQ(data_of(before)["edits"]["unsaved"], nlohmann::json({"--veto " + pair(39, 0)}));
  const std::string second = session.act("loops", "--veto " + pair(36, 3));
  EXPECT_NE(block(before, "keyframe.pose"), block(second, "keyframe.pose"));
  const std::string back = session.act("undo", "");
  EXPECT_EQ(block(before, "keyframe.pose"), block(back, "keyframe.pose"));
  EXPECT_EQ(block(before, "loop.verdict"), block(back, "loop.verdict"));
  session.act("undo", "");
  EXPECT_THAT(session.unsaved(), IsEmpty());
}

TEST_F(View, NothingIsWrittenUntilItIsSaved) {
  workflows::ViewSession session(folder_ / "run");
  session.act("loops", "--veto " + pair(39, 0));
  EXPECT_THAT(map_store::read_loop_decisions(map_store::RunFolder::open(folder_ / "run")), IsEmpty());
  const std::string saved = session.act("save", "");
  EXPECT_TRUE(fs::exists(folder_ / "run.before-1"));
  const std::vector<map_store::LoopDecision> decisions =
      map_store::read_loop_decisions(map_store::RunFolder::open(folder_ / "run"));
  ASSERT_EQ(decisions.size(), 1U);
  EXPECT_EQ(decisions[0].source, 39U);
  EXPECT_EQ(decisions[0].loop_override, map_store::LoopOverride::kVeto);
  EXPECT_THAT(session.unsaved(), IsEmpty());
  EXPECT_THAT(data_of(saved)["message"].get<std::string>(), HasSubstr("run.before-1"));
}

TEST_F(View, ARequestThatMakesNoSenseChangesNothing) {
  workflows::ViewSession session(folder_ / "run");
  for (const std::string& words : {std::string("--veto 0-9999"), std::string("--veto"), std::string("--set 1-2"),
                                   std::string(), "--veto " + pair(39, 0) + " --force 1-2"}) {
    EXPECT_THROW(session.act("loops", words), InputError) << words;
  }
  EXPECT_THROW(session.act("undo", ""), InputError);
  EXPECT_THROW(session.act("save", ""), InputError);
  EXPECT_THROW(session.act("delete", ""), InputError);
  EXPECT_THAT(session.unsaved(), IsEmpty());
}

TEST_F(View, WhatRegistrationSaysOfAPairIsToldBeforeItCounts) {
  workflows::ViewSession session(folder_ / "run");
  EXPECT_THAT(session.act("why", pair(35, 4)), HasSubstr("P(correct)"));
  EXPECT_THAT(session.unsaved(), IsEmpty());
}

TEST_F(View, ThePageOffersEditsAndTalksToItsServerOnly) {
  const std::string page = workflows::ViewSession(folder_ / "run").page();
  EXPECT_EQ(data_of(page)["edits"]["possible"], true);
  EXPECT_THAT(page, HasSubstr("connect-src 'self'"));
}

}  // namespace
}  // namespace loopmark::app
