// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pair_sets/balanced_selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::pair_sets {
namespace {

/// Draws in a row that may miss every candidate before the selection gives up.
constexpr std::size_t kMostMisses = 20'000'000;

/// The candidates that remain, in the unit cube, with a grid over three of its axes.
class Cube {
 public:
  Cube(const std::vector<RegistrationPair>& pool, double radius)
      : pool_(pool),
        radius_(radius),
        cells_(std::max(1, static_cast<int>(std::floor(1.0 / radius)))),
        here_(pool.size(), true) {
    rescale();
  }

  /// Calls visit(candidate, squared distance) for those within the radius of a place, in the order of the pool
  /// within each cell.
  template <class Visit>
  void within(const Vector6d& place, const Visit& visit) const {
    std::array<int, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = cell_of(place[kGridAxes[i]]);
    }
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          visit_cell(key({at[0] + dx, at[1] + dy, at[2] + dz}), place, visit);
        }
      }
    }
  }

  /// Takes a candidate out; the cube is scaled anew when it held a bound.
  void remove(std::size_t index) {
    here_[index] = false;
    const Vector6d& motion = pool_[index].motion;
    if ((motion.array() <= low_.array()).any() || (motion.array() >= high_.array()).any()) {
      rescale();
    } else {
      auto& cell = grid_.at(key_of(unit_[index]));
      cell.erase(std::find(cell.begin(), cell.end(), index));
    }
  }

 private:
  static constexpr std::array<Eigen::Index, 3> kGridAxes = {0, 1, 5};  // x, y, yaw: where drives differ most

  int cell_of(double value) const { return std::clamp(static_cast<int>(std::floor(value * cells_)), 0, cells_ - 1); }
  int key(const std::array<int, 3>& cell) const {
    for (const int c : cell) {
      if (c < 0 || c >= cells_) {
        return -1;
      }
    }
    return (cell[0] * cells_ + cell[1]) * cells_ + cell[2];
  }
  int key_of(const Vector6d& unit) const {
    return key({cell_of(unit[kGridAxes[0]]), cell_of(unit[kGridAxes[1]]), cell_of(unit[kGridAxes[2]])});
  }

  template <class Visit>
  void visit_cell(int cell, const Vector6d& place, const Visit& visit) const {
    const auto found = grid_.find(cell);
    if (cell < 0 || found == grid_.end()) {
      return;
    }
    for (const std::size_t index : found->second) {
      const double squared = ((unit_[index] - place).array() * used_.array()).matrix().squaredNorm();
      if (squared <= radius_ * radius_) {
        visit(index, squared);
      }
    }
  }

  void rescale() {
    low_.setConstant(std::numeric_limits<double>::infinity());
    high_ = -low_;
    for (std::size_t i = 0; i < pool_.size(); ++i) {
      if (here_[i]) {
        low_ = low_.cwiseMin(pool_[i].motion);
        high_ = high_.cwiseMax(pool_[i].motion);
      }
    }
    const Vector6d range = high_ - low_;
    used_ = (range.array() > 1e-12).cast<double>();
    unit_.assign(pool_.size(), Vector6d::Zero());
    grid_.clear();
    for (std::size_t i = 0; i < pool_.size(); ++i) {
      if (here_[i]) {
        for (Eigen::Index axis = 0; axis < 6; ++axis) {
          // Candidates agree on an unused axis; the draw's own place there must not decide about cells.
          unit_[i][axis] = used_[axis] > 0.0 ? (pool_[i].motion[axis] - low_[axis]) / range[axis] : 0.5;
        }
        grid_[key_of(unit_[i])].push_back(i);
      }
    }
  }

 public:
  /// A place as the grid sees it: unused axes in the middle.
  Vector6d settled(const Vector6d& place) const { return (used_.array() > 0.0).select(place, Vector6d::Constant(0.5)); }

 private:
  const std::vector<RegistrationPair>& pool_;
  double radius_;
  int cells_;
  std::vector<bool> here_;
  std::vector<Vector6d> unit_;
  Vector6d low_, high_, used_;
  std::unordered_map<int, std::vector<std::size_t>> grid_;
};

/// Picks one after the other.
class Selection {
 public:
  Selection(const std::vector<RegistrationPair>& pool, const BalanceOptions& options)
      : pool_(pool), cube_(pool, options.radius), rng_(task_seed(options.seed, {0x73656c65U, pool.size()})) {
    for (const RegistrationPair& pair : pool) {
      ++report_.candidates[pair.key.session];
      report_.chosen[pair.key.session] += 0;
    }
  }

  std::vector<RegistrationPair> take(std::size_t count) {
    std::vector<RegistrationPair> picked;
    count = std::min(count, pool_.size());
    while (picked.size() < count) {
      check_interrupt();
      const auto index = pick();
      if (!index) {
        break;
      }
      ++report_.chosen[pool_[*index].key.session];
      cube_.remove(*index);
      picked.push_back(pool_[*index]);
    }
    return picked;
  }

  const SelectionReport& report() const { return report_; }

 private:
  double share_chosen(int session) const {
    return static_cast<double>(report_.chosen.at(session)) / static_cast<double>(report_.candidates.at(session));
  }

  std::optional<std::size_t> pick() {
    for (std::size_t misses = 0; misses < kMostMisses; ++misses) {
      ++report_.draws;
      Vector6d place;
      for (double& value : place) {
        value = rng_.uniform();
      }
      using Rank = std::tuple<double, int, double, std::size_t>;  // share of the drive, drive, distance, candidate
      std::optional<Rank> best;
      cube_.within(cube_.settled(place), [&](std::size_t index, double squared) {
        const int session = pool_[index].key.session;
        const Rank rank{share_chosen(session), session, squared, index};
        if (!best || rank < *best) {
          best = rank;
        }
      });
      if (best) {
        return std::get<3>(*best);
      }
    }
    return std::nullopt;
  }

  const std::vector<RegistrationPair>& pool_;
  Cube cube_;
  Rng rng_;
  SelectionReport report_;
};

}  // namespace

std::vector<RegistrationPair> select_balanced(const std::vector<RegistrationPair>& pool, std::size_t count,
                                              const BalanceOptions& options, SelectionReport* report) {
  check(options);
  Selection selection(pool, options);
  std::vector<RegistrationPair> picked = selection.take(count);
  std::sort(picked.begin(), picked.end(),
            [](const RegistrationPair& a, const RegistrationPair& b) { return a.key < b.key; });
  if (report != nullptr) {
    *report = selection.report();
  }
  return picked;
}

}  // namespace loopmark::pair_sets
