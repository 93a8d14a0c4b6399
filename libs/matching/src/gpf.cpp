// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "loopmark/matching/filters.hpp"

namespace loopmark::matching {
namespace {

/// The cells of the grid over the matched source points, by match.
class MatchGrid {
 public:
  MatchGrid(const Correspondences& matches, const std::vector<Eigen::Vector3f>& source, std::size_t cells)
      : source_(source), cells_(cells) {
    for (const Correspondence& match : matches) {
      if (match.source >= source.size()) {
        throw std::invalid_argument("grid_prioritized_filter: a match names a source point that is not there");
      }
      low_ = low_.cwiseMin(source[match.source].head<2>());
      high_ = high_.cwiseMax(source[match.source].head<2>());
    }
  }

  std::size_t cell_of(const Correspondence& match) const {
    const Eigen::Vector2f& p = source_[match.source].head<2>();
    return along(p, 1) * cells_ + along(p, 0);
  }

 private:
  std::size_t along(const Eigen::Vector2f& p, int axis) const {
    const double extent = static_cast<double>(high_[axis]) - static_cast<double>(low_[axis]);
    if (!(extent > 0.0)) {
      return 0;
    }
    const double unit = (static_cast<double>(p[axis]) - static_cast<double>(low_[axis])) / extent;
    return std::min(cells_ - 1, static_cast<std::size_t>(unit * static_cast<double>(cells_)));
  }

  const std::vector<Eigen::Vector3f>& source_;
  std::size_t cells_;
  Eigen::Vector2f low_ = Eigen::Vector2f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Vector2f high_ = -low_;
};

}  // namespace

std::size_t water_level(const std::vector<std::size_t>& counts, double wanted) {
  const std::size_t highest = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
  // fuller[l]: cells with more than l matches, which is what one more level adds.
  std::vector<std::size_t> fuller(highest, 0);
  for (const std::size_t count : counts) {
    if (count > 0) {
      ++fuller[count - 1];
    }
  }
  for (std::size_t l = highest; l-- > 1;) {
    fuller[l - 1] += fuller[l];
  }
  std::size_t best = 0;
  double best_miss = std::abs(wanted);
  std::size_t sum = 0;
  for (std::size_t level = 1; level <= highest; ++level) {
    sum += fuller[level - 1];
    const double miss = std::abs(static_cast<double>(sum) - wanted);
    if (miss <= best_miss) {
      best = level;
      best_miss = miss;
    }
  }
  return best;
}

Correspondences grid_prioritized_filter(const Correspondences& matches, const std::vector<Eigen::Vector3f>& source,
                                        const GpfOptions& options) {
  check(options);
  const MatchGrid grid(matches, source, options.cells);
  const Correspondences sorted = keep_best(matches, 0);
  std::vector<std::size_t> counts(options.cells * options.cells, 0);
  std::size_t mutual = 0;
  for (const Correspondence& match : sorted) {
    ++counts[grid.cell_of(match)];
    mutual += match.mutual ? 1U : 0U;
  }
  double wanted = options.phi * static_cast<double>(mutual);  // R = phi * |N|, paper eq. 2
  if (options.max_matches > 0) {
    wanted = std::min(wanted, static_cast<double>(options.max_matches));
  }
  const std::size_t level = water_level(counts, wanted);
  std::vector<std::size_t> taken(counts.size(), 0);
  Correspondences kept;
  for (const Correspondence& match : sorted) {
    if (taken[grid.cell_of(match)]++ < level) {
      kept.push_back(match);
    }
  }
  return kept;
}

}  // namespace loopmark::matching
