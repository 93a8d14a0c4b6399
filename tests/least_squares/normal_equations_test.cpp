// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/least_squares/normal_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "loopmark/core/random.hpp"
#include "loopmark/least_squares/factors.hpp"

namespace loopmark::least_squares {
namespace {

using Line = NormalEquations<2>;

/// Points of y = 3 - 2 x with noise; the unknowns are offset and slope.
Line sums_of_line(std::size_t count, std::size_t block) {
  return sum_in_blocks<Line>(count, block, [](std::size_t i, Line& sums) {
    Rng rng(i);
    const double x = 0.01 * static_cast<double>(i);
    sums.add_row({1.0, x}, -(3.0 - 2.0 * x + 0.01 * rng.normal()), 1.0);
  });
}

TEST(NormalEquations, StepSolvesALinearProblemAtOnce) {
  const Eigen::Vector2d x = sums_of_line(500, 64).step();
  EXPECT_NEAR(x[0], 3.0, 5e-3);
  EXPECT_NEAR(x[1], -2.0, 5e-3);
}

TEST(NormalEquations, SumsAreTheSameBytesAtAnyNumberOfThreads) {
  set_thread_count(1);
  const Line one = sums_of_line(5000, 64);
  set_thread_count(4);
  const Line four = sums_of_line(5000, 64);
  set_thread_count(0);
  EXPECT_EQ(one.hessian, four.hessian);
  EXPECT_EQ(one.gradient, four.gradient);
}

TEST(NormalEquations, APriorHoldsWhatNothingElseHolds) {
  NormalEquations<6> sums;
  add_point_to_plane(sums, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0.5, 1.0);
  add_prior(sums, 0, Eigen::Vector3d(1.0, -2.0, 0.0), 1e-3);
  add_prior(sums, 3, Eigen::Vector3d(0.1, 0.2, 0.3), 1e-3);
  const Vector6d xi = sums.step();
  EXPECT_NEAR(xi[0], -1.0, 1e-9) << "back to where the prior is";
  EXPECT_NEAR(xi[1], 2.0, 1e-9);
  EXPECT_NEAR(xi[2], -0.5, 1e-3) << "the plane holds the height";
  EXPECT_NEAR(xi[5], -0.3, 1e-9);
}

TEST(NormalEquations, DampingShortensTheStep) {
  const Line sums = sums_of_line(100, 64);
  EXPECT_LT(sums.step(100.0).norm(), sums.step().norm());
}

TEST(GaussNewton, FindsTheMotionOfPoints) {
  Rng rng(4);
  std::vector<Eigen::Vector3d> points(30);
  for (Eigen::Vector3d& p : points) {
    p = 5.0 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
  }
  Vector6d xi;
  xi << 1.0, -2.0, 0.5, 0.4, -0.3, 0.6;
  const Pose truth = exp_se3(xi);
  Pose T = Pose::Identity();
  const auto step_at = [&](std::size_t) -> std::optional<Vector6d> {
    NormalEquations<6> sums;
    for (const Eigen::Vector3d& p : points) {
      add_point_to_point(sums, T * p, T * p - truth * p, 1.0);
    }
    return sums.step();
  };
  const Convergence found = gauss_newton({50, 1e-9}, step_at, [&](const Vector6d& step) { T = exp_se3(step) * T; });
  EXPECT_TRUE(found.converged);
  EXPECT_LT(found.iterations, 50U);
  EXPECT_LT((T.matrix() - truth.matrix()).norm(), 1e-8);
}

TEST(GaussNewton, StopsWhereTooLittleHoldsAndAtTheLimit) {
  const auto nothing = [](std::size_t) { return std::optional<Eigen::Vector2d>(); };
  const auto ignore = [](const Eigen::Vector2d&) {};
  EXPECT_EQ(gauss_newton({10, 1e-4}, nothing, ignore).iterations, 0U);
  const auto far = [](std::size_t) { return std::optional(Eigen::Vector2d(1.0, 0.0)); };
  const Convergence limit = gauss_newton({10, 1e-4}, far, ignore);
  EXPECT_EQ(limit.iterations, 10U);
  EXPECT_FALSE(limit.converged);
}

}  // namespace
}  // namespace loopmark::least_squares
