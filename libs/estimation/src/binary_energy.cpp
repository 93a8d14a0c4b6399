// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/binary_energy.hpp"

#include <algorithm>
#include <limits>

namespace loopmark::estimation {
namespace {

constexpr double kEmpty = 1e-12;

}  // namespace

BinaryEnergy::BinaryEnergy(std::size_t variables)
    : source_(variables), sink_(variables + 1), unary_(variables, 0.0), out_(variables + 2) {}

void BinaryEnergy::add_unary(std::size_t variable, double value) { unary_[variable] += value; }

void BinaryEnergy::add_pair(std::size_t p, std::size_t q, double e00, double e01, double e10, double e11) {
  unary_[p] += e10 - e00;
  unary_[q] += e11 - e10;
  add_edge(p, q, std::max(0.0, e01 + e10 - e00 - e11));
}

void BinaryEnergy::add_edge(std::size_t from, std::size_t to, double capacity) {
  out_[from].push_back(edges_.size());
  edges_.push_back({to, capacity});
  out_[to].push_back(edges_.size());
  edges_.push_back({from, 0.0});
}

bool BinaryEnergy::level_nodes() {
  level_.assign(out_.size(), -1);
  level_[source_] = 0;
  std::vector<std::size_t> queue{source_};
  for (std::size_t head = 0; head < queue.size(); ++head) {
    for (const std::size_t e : out_[queue[head]]) {
      if (edges_[e].capacity > kEmpty && level_[edges_[e].to] < 0) {
        level_[edges_[e].to] = level_[queue[head]] + 1;
        queue.push_back(edges_[e].to);
      }
    }
  }
  return level_[sink_] >= 0;
}

double BinaryEnergy::push(std::size_t node, double flow) {
  if (node == sink_) {
    return flow;
  }
  for (std::size_t& k = next_[node]; k < out_[node].size(); ++k) {
    const std::size_t e = out_[node][k];
    if (edges_[e].capacity > kEmpty && level_[edges_[e].to] == level_[node] + 1) {
      const double pushed = push(edges_[e].to, std::min(flow, edges_[e].capacity));
      if (pushed > 0.0) {
        edges_[e].capacity -= pushed;
        edges_[e ^ 1U].capacity += pushed;
        return pushed;
      }
    }
  }
  return 0.0;
}

std::vector<bool> BinaryEnergy::minimise() {
  for (std::size_t v = 0; v < unary_.size(); ++v) {
    if (unary_[v] > 0.0) {
      add_edge(source_, v, unary_[v]);
    } else if (unary_[v] < 0.0) {
      add_edge(v, sink_, -unary_[v]);
    }
  }
  while (level_nodes()) {
    next_.assign(out_.size(), 0);
    while (push(source_, std::numeric_limits<double>::infinity()) > 0.0) {
    }
  }
  // After the last ground_alignment, what the source still reaches stands on its side and is 0.
  std::vector<bool> values(unary_.size());
  for (std::size_t v = 0; v < values.size(); ++v) {
    values[v] = level_[v] < 0;
  }
  return values;
}

}  // namespace loopmark::estimation
