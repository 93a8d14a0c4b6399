// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "loopmark/bev/landmarks.hpp"
#include "loopmark/search/voxel_table.hpp"

namespace loopmark::bev {
namespace {

constexpr float kApart = 4.0F;  // metres: landmarks nearer than this to each other give no direction
constexpr float kFarApart = 90.0F;
constexpr float kAsFar = 0.8F;  // metres that the distances of two pairs may differ
constexpr float kMet = 1.0F;    // metres
constexpr float kClearlySeen = 40.0F;
constexpr float kLowWorth = 0.5F;
constexpr float kUnmetCost = 0.25F;
constexpr double kVoteYaw = 0.07;  // radians
constexpr double kVoteMetres = 2.0;
constexpr double kLongest = 105.0;  // metres
constexpr std::size_t kTried = 300;
constexpr int kFewest = 3;

struct Motion {
  float yaw = 0.0F;
  Eigen::Vector2f t = Eigen::Vector2f::Zero();

  Eigen::Vector2f operator*(const Eigen::Vector2f& p) const {
    const float c = std::cos(yaw);
    const float s = std::sin(yaw);
    return {c * p.x() - s * p.y() + t.x(), s * p.x() + c * p.y() + t.y()};
  }
};

Eigen::Vector2f at(const Landmark& landmark) { return {landmark.x, landmark.y}; }

/// The turn and shift that bring a segment onto another, middle on middle.
Motion onto(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& to_a,
            const Eigen::Vector2f& to_b) {
  const Eigen::Vector2f from = b - a;
  const Eigen::Vector2f to = to_b - to_a;
  Motion motion;
  motion.yaw = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  motion.t = 0.5F * (to_a + to_b) - motion * Eigen::Vector2f(0.5F * (a + b));
  return motion;
}

struct Segment {
  float length;
  std::size_t a, b;
};

std::vector<Segment> segments(const std::vector<Landmark>& landmarks) {
  std::vector<Segment> all;
  for (std::size_t a = 0; a < landmarks.size(); ++a) {
    for (std::size_t b = a + 1; b < landmarks.size(); ++b) {
      const float length = (at(landmarks[a]) - at(landmarks[b])).norm();
      if (length > kApart && length < kFarApart) {
        all.push_back({length, a, b});
      }
    }
  }
  std::sort(all.begin(), all.end(), [](const Segment& s, const Segment& t) {
    return std::tie(s.length, s.a, s.b) < std::tie(t.length, t.a, t.b);
  });
  return all;
}

/// Motions that many pairs of landmarks vote for, the most voted first.
std::vector<Motion> vote(const std::vector<Landmark>& source, const std::vector<Landmark>& target) {
  const std::vector<Segment> theirs = segments(target);
  search::VoxelTable bins(4096);
  std::vector<std::pair<int, Motion>> votes;
  const auto count = [&](const Motion& motion) {
    if (motion.t.cwiseAbs().maxCoeff() > kLongest) {
      return;
    }
    const search::Voxel bin = {static_cast<std::int32_t>(std::floor(motion.t.x() / kVoteMetres)),
                               static_cast<std::int32_t>(std::floor(motion.t.y() / kVoteMetres)),
                               static_cast<std::int32_t>(std::floor(motion.yaw / kVoteYaw))};
    const std::uint32_t i = bins.insert(bin);
    votes.resize(bins.size(), {0, motion});
    ++votes[i].first;
  };
  for (const Segment& s : segments(source)) {
    auto t = std::lower_bound(theirs.begin(), theirs.end(), s.length - kAsFar,
                              [](const Segment& a, float length) { return a.length < length; });
    for (; t != theirs.end() && t->length < s.length + kAsFar; ++t) {
      const bool straight = source[s.a].tall == target[t->a].tall && source[s.b].tall == target[t->b].tall;
      const bool crossed = source[s.a].tall == target[t->b].tall && source[s.b].tall == target[t->a].tall;
      if (straight) {
        count(onto(at(source[s.a]), at(source[s.b]), at(target[t->a]), at(target[t->b])));
      }
      if (crossed) {
        count(onto(at(source[s.a]), at(source[s.b]), at(target[t->b]), at(target[t->a])));
      }
    }
  }
  std::stable_sort(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  votes.resize(std::min(votes.size(), kTried));
  std::vector<Motion> motions;
  for (const auto& [n, motion] : votes) {
    motions.push_back(motion);
  }
  return motions;
}

using Matches = std::vector<std::pair<std::size_t, std::size_t>>;

/// The nearest landmark of the target for each of the source, within kMet.
Matches met(const std::vector<Landmark>& source, const std::vector<Landmark>& target, const Motion& motion) {
  Matches matches;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector2f p = motion * at(source[i]);
    float nearest = kMet * kMet;
    std::optional<std::size_t> found;
    for (std::size_t k = 0; k < target.size(); ++k) {
      const float d = (at(target[k]) - p).squaredNorm();
      if (d < nearest) {
        nearest = d;
        found = k;
      }
    }
    if (found) {
      matches.emplace_back(i, *found);
    }
  }
  return matches;
}

/// The least squares motion of matched landmarks.
Motion fitted(const std::vector<Landmark>& source, const std::vector<Landmark>& target, const Matches& matches) {
  Eigen::Vector2f from = Eigen::Vector2f::Zero();
  Eigen::Vector2f to = Eigen::Vector2f::Zero();
  for (const auto& [i, k] : matches) {
    from += at(source[i]);
    to += at(target[k]);
  }
  from /= static_cast<float>(matches.size());
  to /= static_cast<float>(matches.size());
  float cosine = 0.0F;
  float sine = 0.0F;
  for (const auto& [i, k] : matches) {
    const Eigen::Vector2f a = at(source[i]) - from;
    const Eigen::Vector2f b = at(target[k]) - to;
    cosine += a.dot(b);
    sine += a.x() * b.y() - a.y() * b.x();
  }
  Motion motion;
  motion.yaw = std::atan2(sine, cosine);
  motion.t = to - motion * from;
  return motion;
}

float worth(const std::vector<Landmark>& source, const Matches& matches, const Motion& motion) {
  std::vector<bool> is_met(source.size(), false);
  for (const auto& [i, k] : matches) {
    is_met[i] = true;
  }
  float sum = 0.0F;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const float one = source[i].tall ? 1.0F : kLowWorth;
    const bool due = at(source[i]).norm() < kClearlySeen && (motion * at(source[i])).norm() < kClearlySeen;
    sum += is_met[i] ? one : due ? -kUnmetCost * one : 0.0F;
  }
  return sum;
}

}  // namespace

std::vector<PlanarHypothesis> match_landmarks(const std::vector<Landmark>& source, const std::vector<Landmark>& target,
                                              std::size_t most) {
  std::vector<PlanarHypothesis> found;
  for (Motion motion : vote(source, target)) {
    Matches matches = met(source, target, motion);
    for (int round = 0; round < 2 && matches.size() >= 2; ++round) {
      motion = fitted(source, target, matches);
      matches = met(source, target, motion);
    }
    if (matches.size() >= kFewest) {
      found.push_back({motion.yaw, motion.t.x(), motion.t.y(), worth(source, matches, motion)});
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<PlanarHypothesis> distinct;
  for (const PlanarHypothesis& h : found) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const PlanarHypothesis& k) {
      return std::hypot(h.x - k.x, h.y - k.y) < 1.0 && std::abs(std::remainder(h.yaw - k.yaw, 2.0 * M_PI)) < 0.05;
    });
    if (!known && distinct.size() < most) {
      distinct.push_back(h);
    }
  }
  return distinct;
}

double landmark_score(const std::vector<Landmark>& source, const std::vector<Landmark>& target, double yaw, double x,
                      double y) {
  const Motion motion = {static_cast<float>(yaw), {static_cast<float>(x), static_cast<float>(y)}};
  return worth(source, met(source, target, motion), motion);
}

}  // namespace loopmark::bev
