// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Sums of least-squares problems with few unknowns, and Gauss-Newton on them: one core for every aligner of loopmark.
/// What is summed (the factors) and how a step changes the state (the retraction) belong to each aligner.
#pragma once

#include <Eigen/Cholesky>
#include <cstddef>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/pose.hpp"

namespace loopmark::least_squares {

/// Sums over residuals e(x) with Jacobians J = de/dx: hessian = sum w J^T J, gradient = sum w J^T e. Partial sums are
/// added in a fixed order (sum_in_blocks), so that the result does not depend on the number of threads.
template <int N>
struct NormalEquations {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  Matrix hessian = Matrix::Zero();
  Vector gradient = Vector::Zero();

  /// One scalar residual with its Jacobian as a column.
  void add_row(const Vector& jacobian, double residual, double w) {
    const Vector weighted = w * jacobian;
    hessian.noalias() += weighted * jacobian.transpose();
    gradient += residual * weighted;
  }

  /// The step that minimises the sums: -(hessian + damping * I)^-1 gradient.
  Vector step(double damping = 0.0) const {
    Matrix damped = hessian;
    damped.diagonal().array() += damping;
    return -damped.ldlt().solve(gradient);
  }

  NormalEquations& operator+=(const NormalEquations& other) {
    hessian += other.hessian;
    gradient += other.gradient;
    return *this;
  }
};

/// Pulls `count` components of a vector of unknowns, from `first` on, towards `target`: cost w * |x - target|^2.
/// `offset` is x - target.
template <int N, class Offset>
void add_prior(NormalEquations<N>& sums, Eigen::Index first, const Offset& offset, double w) {
  sums.hessian.diagonal().segment(first, offset.size()).array() += w;
  sums.gradient.segment(first, offset.size()) += w * offset;
}

/// The sums of the items 0 to `count` - 1, block by block: the same at any number of threads. `add(i, sums)` adds those
/// of one item. `Sums` has operator+=.
template <class Sums, class Add>
Sums sum_in_blocks(std::size_t count, std::size_t block, const Add& add) {
  const auto of_block = [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      add(i, sums);
    }
    return sums;
  };
  return parallel_reduce_ordered(count, block, Sums{}, of_block, [](Sums& total, const Sums& part) { total += part; });
}

/// When Gauss-Newton stops.
struct StopRule {
  std::size_t max_iterations = 20;
  double step = 1e-4;  ///< norm of a step that changes nothing any more (metres and radians)
};

struct Convergence {
  std::size_t iterations = 0;  ///< steps that were taken
  bool converged = false;      ///< the last step was small enough
};

/// Iterates: `step_at(iteration)` linearizes at the present state and returns the step, or nothing where too little
/// holds the state to go on; `retract(step)` moves the state; `is_small(step, iteration)` says whether that was all.
template <class StepAt, class Retract, class IsSmall>
Convergence gauss_newton(std::size_t max_iterations, const StepAt& step_at, const Retract& retract,
                         const IsSmall& is_small) {
  Convergence result;
  while (result.iterations < max_iterations && !result.converged) {
    const auto step = step_at(result.iterations);
    if (!step) {
      break;
    }
    retract(*step);
    result.converged = is_small(*step, result.iterations);
    ++result.iterations;
  }
  return result;
}

/// The same; a step is small when its norm is.
template <class StepAt, class Retract>
Convergence gauss_newton(const StopRule& stop, const StepAt& step_at, const Retract& retract) {
  return gauss_newton(stop.max_iterations, step_at, retract,
                      [&stop](const auto& step, std::size_t) { return step.norm() < stop.step; });
}

}  // namespace loopmark::least_squares
