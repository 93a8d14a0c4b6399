// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/point_cloud.hpp"

namespace loopmark {
namespace {

template <class T>
std::vector<T> select_channel(const std::vector<T>& channel, const std::vector<std::size_t>& indices) {
  std::vector<T> chosen;
  if (channel.empty()) {
    return chosen;
  }
  chosen.reserve(indices.size());
  for (const std::size_t i : indices) {
    chosen.push_back(channel[i]);
  }
  return chosen;
}

template <class T>
void append_channel(std::vector<T>& channel, const std::vector<T>& more, bool both_have_it) {
  if (both_have_it) {
    channel.insert(channel.end(), more.begin(), more.end());
  } else {
    channel.clear();
  }
}

}  // namespace

PointCloud transformed(const PointCloud& cloud, const Pose& T_target_source) {
  PointCloud moved = cloud;
  const Eigen::Isometry3f transform = T_target_source.cast<float>();
  for (Eigen::Vector3f& point : moved.points) {
    point = transform * point;
  }
  return moved;
}

PointCloud select(const PointCloud& cloud, const std::vector<std::size_t>& indices) {
  return {select_channel(cloud.points, indices), select_channel(cloud.intensity, indices),
          select_channel(cloud.time_offset_s, indices), select_channel(cloud.ring, indices)};
}

void append(PointCloud& cloud, const PointCloud& more) {
  if (more.empty()) {
    return;
  }
  const bool first = cloud.empty();
  const auto both = [&](const auto& a, const auto& b) { return !b.empty() && (first || a.size() == cloud.size()); };
  append_channel(cloud.intensity, more.intensity, both(cloud.intensity, more.intensity));
  append_channel(cloud.time_offset_s, more.time_offset_s, both(cloud.time_offset_s, more.time_offset_s));
  append_channel(cloud.ring, more.ring, both(cloud.ring, more.ring));
  cloud.points.insert(cloud.points.end(), more.points.begin(), more.points.end());
}

}  // namespace loopmark
