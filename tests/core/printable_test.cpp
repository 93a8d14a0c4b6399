// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/printable.hpp"

#include <gtest/gtest.h>

#include "loopmark/core/error.hpp"

namespace loopmark {
namespace {

TEST(Printable, LeavesTextAndTakesTheTeethOutOfControlCharacters) {
  EXPECT_EQ(printable("day 1\t\xc3\xa4 \xe2\x82\xac \xf0\x9f\x9a\x97\n"),
            "day 1\t\xc3\xa4 \xe2\x82\xac \xf0\x9f\x9a\x97\n");
  EXPECT_EQ(printable("a\x1b]0;pwned\x07"), "a\\x1b]0;pwned\\x07");
  EXPECT_EQ(printable("\r\x7f"), "\\x0d\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\xc2\\x9b2J")
      << "CSI as one character";
}

TEST(Printable, BytesThatAreNoUtf8AreShownAsNumbers) {
  EXPECT_EQ(printable("latin-\xe4"), "latin-\\xe4");
  for (const char* text : {"\xe4", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\x80", "\xff"}) {
    EXPECT_FALSE(is_utf8(text)) << printable(text);
  }
  EXPECT_TRUE(is_utf8("\xc3\xa4 \xe2\x82\xac \xf0\x9f\x9a\x97"));
  EXPECT_TRUE(is_utf8(""));
}

TEST(Printable, HexadecimalComesBack) {
  const std::string bytes(
      "\x00\xff"
      "a\xe4",
      4);
  EXPECT_EQ(hex_of(bytes), "00ff61e4");
  EXPECT_EQ(bytes_of_hex(hex_of(bytes)), bytes);
  EXPECT_THROW(bytes_of_hex("0"), InputError);
  EXPECT_THROW(bytes_of_hex("0g"), InputError);
}

}  // namespace
}  // namespace loopmark
