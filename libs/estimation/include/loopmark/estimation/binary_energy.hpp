// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace loopmark::estimation {

/// Minimises sums of unary and submodular pairwise terms of binary variables by a minimum cut (Kolmogorov and Zabih
/// 2004; flow by Dinic's algorithm).
class BinaryEnergy {
 public:
  explicit BinaryEnergy(std::size_t variables);

  /// Adds `value` where the variable is 1.
  void add_unary(std::size_t variable, double value);
  /// Adds e00, e01, e10, e11 for the values of (p, q); e01 + e10 >= e00 + e11.
  void add_pair(std::size_t p, std::size_t q, double e00, double e01, double e10, double e11);

  /// The minimising values.
  std::vector<bool> minimise();

 private:
  struct Edge {
    std::size_t to;
    double capacity;
  };
  void add_edge(std::size_t from, std::size_t to, double capacity);
  bool level_nodes();
  double push(std::size_t node, double flow);

  std::size_t source_, sink_;
  std::vector<double> unary_;
  std::vector<Edge> edges_;  ///< an edge and its reverse are neighbours
  std::vector<std::vector<std::size_t>> out_;
  std::vector<int> level_;
  std::vector<std::size_t> next_;
};

}  // namespace loopmark::estimation
