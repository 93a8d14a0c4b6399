// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/places/place_index.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "inverted_file.hpp"

namespace loopmark::places {
namespace {

using internal::InvertedFile;
using internal::kShort;

constexpr std::size_t kExactUpTo = 4096;  ///< places that are simply all compared
constexpr std::size_t kGrowth = 3;        ///< the centres are learned again when there are so many times more
constexpr std::size_t kCompared = 400;    ///< candidates compared in full, besides 4 k

struct Candidate {
  float squared = 0.0F;
  std::uint32_t place = 0;
  bool operator<(const Candidate& other) const {
    return squared < other.squared || (squared == other.squared && place < other.place);
  }
};

void keep_best(std::vector<Candidate>& candidates, std::size_t count) {
  if (candidates.size() > count) {
    std::nth_element(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count), candidates.end());
    candidates.resize(count);
  }
}

}  // namespace

struct PlaceIndex::State {
  std::size_t dimensions = 0;
  std::vector<std::size_t> ids;
  std::vector<float> full;   ///< descriptors one after another
  std::vector<float> brief;  ///< projected ones, once there are many
  Eigen::MatrixXf projection;
  internal::InvertedFile file;
  std::size_t learned_from = 0;

  Eigen::Map<const Eigen::VectorXf> descriptor(std::size_t place) const {
    return {full.data() + place * dimensions, static_cast<Eigen::Index>(dimensions)};
  }
  void project_last();
  void learn();
  std::vector<PlaceMatch> best(std::vector<Candidate> candidates, const PlaceDescriptor& query, std::size_t k) const;
};

void PlaceIndex::State::project_last() {
  const Eigen::VectorXf brief_one = projection * descriptor(ids.size() - 1);
  brief.insert(brief.end(), brief_one.data(), brief_one.data() + internal::kShort);
  if (learned_from > 0) {
    file.add(brief_one);
  }
}

void PlaceIndex::State::learn() {
  file.build(Eigen::Map<const Eigen::MatrixXf>(brief.data(), internal::kShort, static_cast<Eigen::Index>(ids.size())));
  learned_from = ids.size();
}

std::vector<PlaceMatch> PlaceIndex::State::best(std::vector<Candidate> candidates, const PlaceDescriptor& query,
                                                std::size_t k) const {
  const Eigen::Map<const Eigen::VectorXf> q(query.values.data(), static_cast<Eigen::Index>(dimensions));
  for (Candidate& candidate : candidates) {
    candidate.squared = (descriptor(candidate.place) - q).squaredNorm();
  }
  keep_best(candidates, k);
  std::sort(candidates.begin(), candidates.end());
  std::vector<PlaceMatch> matches;
  for (const Candidate& candidate : candidates) {
    matches.push_back({ids[candidate.place], std::sqrt(static_cast<double>(candidate.squared))});
  }
  return matches;
}

PlaceIndex::PlaceIndex() : state_(std::make_unique<State>()) {}
PlaceIndex::~PlaceIndex() = default;
PlaceIndex::PlaceIndex(PlaceIndex&&) noexcept = default;
PlaceIndex& PlaceIndex::operator=(PlaceIndex&&) noexcept = default;

std::size_t PlaceIndex::size() const { return state_->ids.size(); }

void PlaceIndex::add(std::size_t id, const PlaceDescriptor& descriptor) {
  State& s = *state_;
  if (s.ids.empty()) {
    s.dimensions = descriptor.values.size();
    s.projection = internal::projection(static_cast<Eigen::Index>(s.dimensions));
  }
  if (descriptor.values.size() != s.dimensions) {
    throw std::invalid_argument("a place descriptor of another size than those before");
  }
  s.ids.push_back(id);
  s.full.insert(s.full.end(), descriptor.values.begin(), descriptor.values.end());
  s.project_last();
  if (s.ids.size() > kExactUpTo && s.ids.size() >= kGrowth * s.learned_from) {
    s.learn();
  }
}

std::vector<PlaceMatch> PlaceIndex::query(const PlaceDescriptor& descriptor, std::size_t k,
                                          const std::function<bool(std::size_t)>& accept) const {
  const State& s = *state_;
  if (s.learned_from == 0) {
    return query_exactly(descriptor, k, accept);
  }
  if (descriptor.values.size() != s.dimensions) {
    throw std::invalid_argument("a place descriptor of another size than those of the index");
  }
  const Eigen::Map<const Eigen::VectorXf> full(descriptor.values.data(), static_cast<Eigen::Index>(s.dimensions));
  const Eigen::VectorXf brief = s.projection * full;
  std::vector<Candidate> candidates;
  s.file.visit_near(brief, [&](std::uint32_t place, float squared) {
    if (!accept || accept(s.ids[place])) {
      candidates.push_back({squared, place});
    }
  });
  keep_best(candidates, kCompared + 4 * k);
  return s.best(std::move(candidates), descriptor, k);
}

std::vector<PlaceMatch> PlaceIndex::query_exactly(const PlaceDescriptor& descriptor, std::size_t k,
                                                  const std::function<bool(std::size_t)>& accept) const {
  const State& s = *state_;
  if (s.ids.empty()) {
    return {};
  }
  if (descriptor.values.size() != s.dimensions) {
    throw std::invalid_argument("a place descriptor of another size than those of the index");
  }
  std::vector<Candidate> candidates;
  for (std::uint32_t place = 0; place < s.ids.size(); ++place) {
    if (!accept || accept(s.ids[place])) {
      candidates.push_back({0.0F, place});
    }
  }
  return s.best(std::move(candidates), descriptor, k);
}

}  // namespace loopmark::places
