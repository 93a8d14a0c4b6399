// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace loopmark::search {

/// A point of the tree that answers a query.
struct Neighbour {
  std::uint32_t index = 0;
  float squared_distance = 0.0F;  ///< metres^2
};

/// Exact nearest neighbours in three dimensions. Queries are thread-safe; ties go to the tree's order,
/// which depends on the points only.
class KdTree {
 public:
  explicit KdTree(std::vector<Eigen::Vector3f> points);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  const std::vector<Eigen::Vector3f>& points() const;

  /// The nearest point nearer than max_distance (metres), if any.
  std::optional<Neighbour> nearest(const Eigen::Vector3f& query, float max_distance) const;

  /// The k nearest points, nearest first; fewer when the tree has fewer.
  std::vector<Neighbour> k_nearest(const Eigen::Vector3f& query, std::size_t k) const;

  /// All points nearer than `radius` (metres), nearest first.
  std::vector<Neighbour> within(const Eigen::Vector3f& query, float radius) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace loopmark::search
