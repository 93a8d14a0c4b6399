// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Options as plain structs with one home for each default. A struct `Foo` is made known to YAML, --set and
/// `loopmark config dump` by a function template beside it, found by argument-dependent lookup:
///
///   template <class Visitor>
///   void describe(Visitor& v, FooOptions& o) {
///     v.field("voxel_m", o.voxel_m, "edge of a voxel, metres");
///     v.choice("sampler", o.sampler, {{"uniform", Sampler::kUniform}, {"prosac", Sampler::kProsac}}, "...");
///     v.section("icp", o.icp, "refinement of the estimate");
///   }
///
/// Field types: bool, int, std::size_t, std::uint64_t, double, std::string, std::vector<double>.
/// `void check(const FooOptions&)` throws InputError naming the field when a value makes no sense.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "loopmark/core/error.hpp"

namespace loopmark {

/// The named values of an enumeration.
template <class Enum>
using Choices = std::vector<std::pair<std::string, Enum>>;

/// Throws InputError unless `ok`: "option NAME: PROBLEM".
inline void require_option(bool ok, const std::string& name, const std::string& problem) {
  if (!ok) {
    throw InputError("option " + name + ": " + problem);
  }
}

}  // namespace loopmark
