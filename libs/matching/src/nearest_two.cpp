// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/matching/nearest_two.hpp"

#include <algorithm>
#include <stdexcept>

#include "feature_index.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark {

TwoWayNearest nearest_two(const DescriptorMatrix& source, const DescriptorMatrix& target) {
  TwoWayNearest out;
  out.forward.resize(static_cast<std::size_t>(source.rows()));
  out.backward.resize(static_cast<std::size_t>(target.rows()));
  if (source.rows() == 0 || target.rows() == 0) {
    return out;
  }
  if (source.cols() != target.cols()) {
    throw std::invalid_argument("nearest_two: descriptors of different length");
  }
  const PrincipalFrame frame = PrincipalFrame::of(source, target);
  const FeatureIndex sources(source, frame);
  const FeatureIndex targets(target, frame);
  // The bounds are rounded to float: off by at most this much (squared, times the 1000 of the relative margin).
  const double largest = std::max(sources.largest(), targets.largest());
  const double rounding = 1e-6 * largest;
  const double slack = 1000.0 * rounding * rounding;
  parallel_for(sources.leaves() + targets.leaves(), [&](std::size_t task) {
    const bool forward = task < sources.leaves();
    const FeatureIndex& queries = forward ? sources : targets;
    const std::size_t begin = (forward ? task : task - sources.leaves()) * kernels::kLeaf;
    const std::size_t end = std::min(queries.size(), begin + kernels::kLeaf);
    (forward ? targets : sources).search(queries, begin, end, slack, forward ? out.forward : out.backward);
  });
  return out;
}

}  // namespace loopmark
