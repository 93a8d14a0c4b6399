// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Short YAML that stands for trees without end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "loopmark/config/node.hpp"
#include "loopmark/core/error.hpp"

namespace {

using loopmark::InputError;
using loopmark::config::parse_yaml;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(HostileYaml, AnAliasThatHoldsItselfIsRefused) {
  EXPECT_THAT([] { parse_yaml("a: &a [*a]", "x.yaml"); },
              ThrowsMessage<InputError>(HasSubstr("x.yaml:1: values are nested")));
  EXPECT_THAT([] { parse_yaml("a: &a\n  b: *a", "x.yaml"); }, ThrowsMessage<InputError>(HasSubstr("holds itself")));
}

TEST(HostileYaml, AliasesThatMultiplyAreRefused) {
  std::string text = "a: &a [x,x,x,x,x,x,x,x,x,x]\n";
  for (char c = 'b'; c <= 'i'; ++c) {
    const std::string before = "*" + std::string(1, static_cast<char>(c - 1));
    text += std::string(1, c) + ": &" + c + " [" + before;
    for (int i = 0; i < 9; ++i) {
      text += "," + before;
    }
    text += "]\n";
  }
  EXPECT_THAT([&] { parse_yaml(text, "bomb.yaml"); }, ThrowsMessage<InputError>(HasSubstr("more than 100000 values")));
}

TEST(HostileYaml, DeepNestingIsRefused) {
  for (const std::size_t depth : {100U, 100000U}) {
    EXPECT_THROW(parse_yaml("a: " + std::string(depth, '['), "x.yaml"), InputError) << depth;
    EXPECT_THROW(parse_yaml("a: " + std::string(depth, '[') + std::string(depth, ']'), "x.yaml"), InputError) << depth;
  }
}

TEST(HostileYaml, AnHonestAliasStillWorks) {
  const auto node = parse_yaml("a: &a [1, 2]\nb: *a", "x.yaml");
  ASSERT_EQ(node.keys.size(), 2U);
  EXPECT_EQ(node.keys[1].value.items.size(), 2U);
}

}  // namespace
