// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/core/options.hpp"
#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::features {

constexpr int kFpfhDimension = 33;

struct FpfhOptions {
  double radius_m = 2.4;
};

template <class Visitor>
void describe(Visitor& v, FpfhOptions& o) {
  v.field("radius_m", o.radius_m, "neighbours within this distance make the descriptor, metres");
}

inline void check(const FpfhOptions& o) { require_option(o.radius_m > 0, "radius_m", "must be larger than 0"); }

/// Fast Point Feature Histograms (Rusu et al. 2009): 3 x 11 bins a point, each of the three histograms summing
/// to 100; the same values as PCL's. Rows are in the order of `wanted`, or of all points where `wanted` is empty;
/// neighbours are always all points. Points without a normal (zero) are no neighbours and get a zero row.
search::DescriptorMatrix fpfh(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
                              const FpfhOptions& options, const std::vector<std::size_t>& wanted = {});

}  // namespace loopmark::features
