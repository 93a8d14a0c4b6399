// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/config/options_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <limits>

namespace {

using loopmark::InputError;
using testing::HasSubstr;
using testing::ThrowsMessage;

enum class Colour { kRed, kGreen };

struct InnerOptions {
  double voxel_m = 0.1;
  std::size_t count = 7;
  Colour colour = Colour::kGreen;
};

template <class Visitor>
void describe(Visitor& v, InnerOptions& o) {
  v.field("voxel_m", o.voxel_m, "edge of a voxel, metres");
  v.field("count", o.count, "how many");
  v.choice("colour", o.colour, {{"red", Colour::kRed}, {"green", Colour::kGreen}}, "colour of all");
}

void check(const InnerOptions& o) { loopmark::require_option(o.voxel_m > 0.0, "voxel_m", "must be above 0"); }

struct OuterOptions {
  bool on = true;
  int offset = -3;
  std::uint64_t seed = 1;
  std::string name = "a \"b\" \\ c\nd: # e";
  std::vector<double> weights = {1.0, 0.1, 1e-9};
  InnerOptions inner;
  InnerOptions other;
};

template <class Visitor>
void describe(Visitor& v, OuterOptions& o) {
  v.field("on", o.on, "a switch");
  v.field("offset", o.offset, "an offset");
  v.field("seed", o.seed, "a seed");
  v.field("name", o.name, "a name");
  v.field("weights", o.weights, "some weights");
  v.section("inner", o.inner, "the inner room");
  v.section("other", o.other, "the other room");
}

OuterOptions read(const std::string& yaml) {
  OuterOptions options;
  loopmark::config::apply(options, loopmark::config::parse_yaml(yaml, "my.yaml"));
  return options;
}

OuterOptions set(const std::vector<std::string>& settings) {
  return loopmark::config::load<OuterOptions>("", settings);
}

auto fails_with(const std::string& text) { return ThrowsMessage<InputError>(HasSubstr(text)); }

TEST(Options, EveryTypeIsRead) {
  const OuterOptions o = read(
      "on: false\noffset: -12\nseed: 18446744073709551615\nname: town\nweights: [0.5, 2, -1e3]\n"
      "inner:\n  voxel_m: 0.25\n  colour: red\n");
  EXPECT_FALSE(o.on);
  EXPECT_EQ(o.offset, -12);
  EXPECT_EQ(o.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(o.name, "town");
  EXPECT_EQ(o.weights, (std::vector<double>{0.5, 2.0, -1000.0}));
  EXPECT_EQ(o.inner.voxel_m, 0.25);
  EXPECT_EQ(o.inner.colour, Colour::kRed);
  EXPECT_EQ(o.inner.count, 7U) << "what is not named keeps its value";
}

TEST(Options, DumpReadsBackAsTheSame) {
  OuterOptions o;
  o.inner = {1.0 / 3.0, 12345678901234, Colour::kRed};
  o.weights = {std::numeric_limits<double>::denorm_min(), 1.0, 1e300, -0.1};
  const std::string yaml = loopmark::config::dump(o);
  const OuterOptions back = read(yaml);
  EXPECT_EQ(back.inner.voxel_m, o.inner.voxel_m);
  EXPECT_EQ(back.inner.count, o.inner.count);
  EXPECT_EQ(back.inner.colour, o.inner.colour);
  EXPECT_EQ(back.weights, o.weights);
  EXPECT_EQ(back.name, o.name);
  EXPECT_EQ(loopmark::config::dump(back), yaml);
  EXPECT_THAT(yaml, HasSubstr("# edge of a voxel, metres"));
  EXPECT_THAT(yaml, HasSubstr("(red | green)"));
}

TEST(Options, EmptyFilesAndSectionsChangeNothing) {
  const std::string defaults = loopmark::config::dump(OuterOptions());
  for (const char* yaml : {"", "# only a comment\n", "inner:\n", "{}\n"}) {
    EXPECT_EQ(loopmark::config::dump(read(yaml)), defaults) << yaml;
  }
}

TEST(Options, UnknownKeyNamesFileLineAndTheNearest) {
  EXPECT_THAT([] { read("on: true\ninner:\n  voxel: 1\n"); },
              fails_with("my.yaml:3: unknown option 'inner.voxel' (did you mean 'inner.voxel_m'?)"));
  EXPECT_THAT([] { read("iner:\n  voxel_m: 1\n"); }, fails_with("did you mean 'inner'?"));
  EXPECT_THAT([] { read("voxel_m: 1\n"); }, fails_with("did you mean 'inner.voxel_m'?"));
  EXPECT_THAT([] { read("zebra: 1\n"); }, fails_with("'loopmark config dump' lists all"));
}

TEST(Options, IllTypedValueNamesWhatWasExpected) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"on: yes please", "my.yaml:1: on: expected true or false, got 'yes please'"},
      {"offset: 1.5", "my.yaml:1: offset: expected a whole number, got '1.5'"},
      {"offset: 3000000000", "expected a whole number"},
      {"seed: -1", "my.yaml:1: seed: expected a whole number, not below 0, got '-1'"},
      {"inner: {voxel_m: wide}", "my.yaml:1: inner.voxel_m: expected a number, got 'wide'"},
      {"inner: {voxel_m: .nan}", "expected a number"},
      {"inner: {voxel_m: 1e999}", "expected a number"},
      {"inner:\n  voxel_m: [1]", "my.yaml:2: inner.voxel_m: expected a number, got a list"},
      {"inner: 3", "my.yaml:1: inner: expected a section with names and values, got '3'"},
      {"weights: 3", "expected a list of numbers"},
      {"weights: [1, x]", "weights: expected a number, got 'x'"},
      {"\ninner:\n  colour: blue", "my.yaml:3: inner.colour: expected one of red, green, got 'blue'"},
      {"- 1", "expected a section"},
  };
  for (const auto& [yaml, message] : cases) {
    EXPECT_THAT([&yaml = yaml] { read(yaml); }, fails_with(message)) << yaml;
  }
}

TEST(Options, MalformedYamlNamesTheLine) {
  EXPECT_THAT([] { read("on: true\ninner: [1, 2\n"); }, fails_with("my.yaml:3: not valid YAML"));
  EXPECT_THAT([] { read("on: true\noffset: 1\non: false\n"); },
              fails_with("my.yaml:3: 'on' is given twice, first in line 1"));
}

TEST(Options, SettingsChangeOneValueEach) {
  const OuterOptions o = set({"inner.voxel_m=0.5", "weights=[1, 2]", "inner.voxel_m=0.75", "name=x=y"});
  EXPECT_EQ(o.inner.voxel_m, 0.75) << "the last one wins";
  EXPECT_EQ(o.weights, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(o.name, "x=y");
  EXPECT_THAT([] { set({"inner.voxel=1"}); },
              fails_with("--set inner.voxel=1: unknown option 'inner.voxel' (did you mean 'inner.voxel_m'?)"));
  EXPECT_THAT([] { set({"inner.voxel_m"}); }, fails_with("not of the form section.name=value"));
  EXPECT_THAT([] { set({"offset=x"}); }, fails_with("--set offset=x: offset: expected a whole number"));
}

TEST(Options, ChecksSayWhereTheValueWasSet) {
  const std::string file = testing::TempDir() + "options_check_test.yaml";
  std::ofstream(file) << "on: true\nother:\n  voxel_m: -1\n";
  EXPECT_THAT([&] { loopmark::config::load<OuterOptions>(file, {}); },
              fails_with(file + ":3: other.voxel_m: must be above 0"));
  EXPECT_THAT([&] { loopmark::config::load<OuterOptions>(file, {"other.voxel_m=-2"}); },
              fails_with("--set other.voxel_m=-2: other.voxel_m: must be above 0"));
  EXPECT_NO_THROW(loopmark::config::load<OuterOptions>(file, {"other.voxel_m=2"}));
  EXPECT_THAT([] { loopmark::config::load<OuterOptions>("/nowhere/at-all.yaml", {}); }, fails_with("at-all.yaml"));
}

}  // namespace
