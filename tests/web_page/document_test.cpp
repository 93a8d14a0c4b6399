// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/web_page/document.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "loopmark/web_page/base64.hpp"
#include "loopmark/web_page/block.hpp"
#include "loopmark/web_page/bundle.hpp"

namespace loopmark::web_page {
namespace {

// RFC 4648, section 10.
TEST(Base64, GivesTheVectorsOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

std::string written(const Document& document) {
  std::ostringstream out;
  document.write(out);
  return out.str();
}

TEST(Document, WordsAreText) {
  const std::string page = written(Document("a <b> title", "{}", {{"1 < 2", {"R&D \"quoted\""}}}));
  EXPECT_NE(page.find("<title>a &lt;b&gt; title</title>"), std::string::npos);
  EXPECT_NE(page.find("<h2>1 &lt; 2</h2>"), std::string::npos);
  EXPECT_NE(page.find("R&amp;D &quot;quoted&quot;"), std::string::npos);
}

TEST(Document, JsonCannotEndItsElement) {
  const std::string page = Document("t", R"({"name":"</script><script>x"})", {}).data();
  EXPECT_NE(page.find(R"({"name":"\u003c/script>\u003cscript>x"})"), std::string::npos);
}

TEST(Document, ForbidsWhatIsNotItsOwn) {
  const std::string page = written(Document("t", "{}", {}));
  EXPECT_NE(page.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
  EXPECT_EQ(page.find("unsafe-eval"), std::string::npos);
  EXPECT_EQ(page.find("connect-src"), std::string::npos);
  Document served("t", "{}", {});
  served.allow_own_server();
  EXPECT_NE(written(served).find("; connect-src 'self'"), std::string::npos);
}

TEST(Document, HoldsItsScriptAndLicencesOrSaysWhatItLacks) {
  const std::string page = written(Document("t", "{}", {}));
  const Bundle& made = bundle();
  EXPECT_EQ(made.problem.empty(), !made.script.empty());
  if (made.problem.empty()) {
    EXPECT_NE(page.find(made.script), std::string::npos);
    EXPECT_NE(made.licences.find("three"), std::string_view::npos);
    EXPECT_NE(made.licences.find("uplot"), std::string_view::npos);
  } else {
    EXPECT_NE(page.find("This page has no map"), std::string::npos);
  }
}

TEST(Block, NamesWhatThePageMustUndo) {
  const std::string floats = block("a.b", std::vector<float>{1.0F});
  EXPECT_NE(floats.find("data-name=\"a.b\" data-type=\"f32\" data-filter=\"planes\""), std::string::npos);
  const std::string whole = block("c", std::vector<std::uint32_t>{1, 2});
  EXPECT_NE(whole.find("data-type=\"u32\" data-filter=\"delta planes\""), std::string::npos);
}

TEST(Block, NeighboursThatAreAlikeTakeLittleRoom) {
  std::vector<std::uint32_t> rising(10'000);
  for (std::size_t i = 0; i < rising.size(); ++i) {
    rising[i] = static_cast<std::uint32_t>(1'000'000 + 3 * i);
  }
  EXPECT_LT(block("n", rising).size(), 400U);
}

}  // namespace
}  // namespace loopmark::web_page
