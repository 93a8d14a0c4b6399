// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/search/kd_tree.hpp"

#include <algorithm>
#include <nanoflann.hpp>
#include <utility>

namespace loopmark::search {
namespace {

/// nanoflann's view of a vector of points.
struct Adaptor {
  const std::vector<Eigen::Vector3f>& points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3, std::uint32_t>;

constexpr std::size_t kLeafSize = 12;

bool nearer(const Neighbour& a, const Neighbour& b) {
  return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance : a.index < b.index;
}

}  // namespace

struct KdTree::Impl {
  explicit Impl(std::vector<Eigen::Vector3f> all)
      : points(std::move(all)),
        adaptor{points},
        tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {}

  std::vector<Eigen::Vector3f> points;
  Adaptor adaptor;
  Tree tree;
};

KdTree::KdTree(std::vector<Eigen::Vector3f> points) : impl_(std::make_unique<Impl>(std::move(points))) {
  impl_->tree.buildIndex();
}

KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

const std::vector<Eigen::Vector3f>& KdTree::points() const { return impl_->points; }

std::optional<Neighbour> KdTree::nearest(const Eigen::Vector3f& query, float max_distance) const {
  Neighbour found{0, max_distance * max_distance};
  if (impl_->points.empty()) {
    return std::nullopt;
  }
  nanoflann::KNNResultSet<float, std::uint32_t> result(1);
  result.init(&found.index, &found.squared_distance);
  found.squared_distance = max_distance * max_distance;
  impl_->tree.findNeighbors(result, query.data(), nanoflann::SearchParams());
  return result.size() == 1 ? std::optional(found) : std::nullopt;
}

std::vector<Neighbour> KdTree::k_nearest(const Eigen::Vector3f& query, std::size_t k) const {
  k = std::min(k, impl_->points.size());
  std::vector<std::uint32_t> indices(k);
  std::vector<float> distances(k);
  if (k > 0) {
    impl_->tree.knnSearch(query.data(), k, indices.data(), distances.data());
  }
  std::vector<Neighbour> found;
  found.reserve(k);
  for (std::size_t i = 0; i < k; ++i) {
    found.push_back({indices[i], distances[i]});
  }
  std::sort(found.begin(), found.end(), nearer);
  return found;
}

std::vector<Neighbour> KdTree::within(const Eigen::Vector3f& query, float radius) const {
  std::vector<Neighbour> found;
  if (impl_->points.empty()) {
    return found;
  }
  std::vector<std::pair<std::uint32_t, float>> matches;
  impl_->tree.radiusSearch(query.data(), radius * radius, matches, nanoflann::SearchParams(32, 0.0F, false));
  found.reserve(matches.size());
  for (const auto& [index, distance] : matches) {
    found.push_back({index, distance});
  }
  std::sort(found.begin(), found.end(), nearer);
  return found;
}

}  // namespace loopmark::search
