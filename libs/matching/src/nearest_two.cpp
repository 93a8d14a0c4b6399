// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/matching/nearest_two.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <stdexcept>

#include "loopmark/core/parallel.hpp"
#include "nearest_answers.hpp"
#include "pca_basis.hpp"

namespace loopmark::matching {
namespace {

using internal::kChunk;
using internal::kChunks;

/// One cloud and what its places have found in the other.
struct Side {
  const internal::PcaBuckets& leaves;
  internal::NearestAnswers& answers;
};

float distance(const internal::PcaBuckets& a, std::size_t place_a, const internal::PcaBuckets& b, std::size_t place_b) {
  return internal::row_distance(a.row(place_a), b.row(place_b), a.padded());
}

/// Offers those of two chunks to each other that are near enough.
void meet(const Side& a, std::size_t chunk_a, const Side& b, std::size_t chunk_b) {
  static const internal::ScanChunks scan = internal::scan_chunks();
  std::array<std::uint16_t, internal::kChunk> hits;
  if (!scan(a.leaves.queries(chunk_a, a.answers.limits()), b.leaves.targets(chunk_b, b.answers.limits()),
            a.leaves.pairs(), hits.data())) {
    return;
  }
  bool taken_a = false;
  bool taken_b = false;
  for (std::size_t q = 0; q < internal::kChunk; ++q) {
    for (std::uint32_t lanes = hits[q]; lanes != 0; lanes &= lanes - 1) {
      const std::size_t place_a = chunk_a * internal::kChunk + q;
      const std::size_t place_b = chunk_b * internal::kChunk + static_cast<std::size_t>(std::countr_zero(lanes));
      if (place_a >= a.leaves.size() || place_b >= b.leaves.size()) {
        continue;
      }
      const std::uint32_t row_a = a.leaves.original(place_a);
      const std::uint32_t row_b = b.leaves.original(place_b);
      if (a.answers.is_open_to(place_a, row_b) || b.answers.is_open_to(place_b, row_a)) {
        const float squared = distance(a.leaves, place_a, b.leaves, place_b);
        taken_a = a.answers.offer(place_a, row_b, squared) || taken_a;
        taken_b = b.answers.offer(place_b, row_a, squared) || taken_b;
      }
    }
  }
  if (taken_a) {
    a.answers.narrow(chunk_a);
  }
  if (taken_b) {
    b.answers.narrow(chunk_b);
  }
}

std::size_t lowest(const float* begin, std::size_t count) {
  return static_cast<std::size_t>(std::min_element(begin, begin + count) - begin);
}

/// Each place of a leaf meets the chunk of the other cloud that is nearest to its own: whatever is found there, others
/// need to be nearer.
void start_leaf(const Side& a, const internal::PcaBuckets& b, std::size_t leaf) {
  std::vector<float> bounds;
  std::array<float, internal::kChunks> of_chunks;
  const std::size_t end = std::min(a.leaves.chunks(), (leaf + 1) * internal::kChunks);
  for (std::size_t chunk = leaf * internal::kChunks; chunk < end; ++chunk) {
    b.bounds_to_leaves(a.leaves, chunk, bounds);
    const std::size_t home = lowest(bounds.data(), bounds.size());
    b.bounds_to_chunks(a.leaves, chunk, home, of_chunks.data());
    const std::size_t first =
        (home * internal::kChunks + lowest(of_chunks.data(), internal::kChunks)) * internal::kChunk;
    for (std::size_t place = chunk * internal::kChunk;
         place < std::min(a.leaves.size(), (chunk + 1) * internal::kChunk); ++place) {
      for (std::size_t other = first; other < std::min(b.size(), first + internal::kChunk); ++other) {
        a.answers.offer(place, b.original(other), distance(a.leaves, place, b, other));
      }
    }
    a.answers.narrow(chunk);
  }
}

internal::NearestAnswers start(const internal::PcaBuckets& a, const internal::PcaBuckets& b,
                               const internal::WholeNumbers& scale) {
  internal::NearestAnswers answers(a, scale);
  parallel_for(a.leaves(), [&](std::size_t leaf) { start_leaf({a, answers}, b, leaf); });
  return answers;
}

/// Room for what search_chunk does over and over.
struct Workspace {
  std::vector<float> bounds;
  std::vector<std::uint64_t> nearest;  ///< bound and leaf, to be sorted
};

/// The chunk meets all chunks of the other cloud that one of the two may still find something in, near leaves first.
void search_chunk(const Side& a, std::size_t chunk, const Side& b, Workspace& work) {
  b.leaves.bounds_to_leaves(a.leaves, chunk, work.bounds);
  const auto in_reach = [&](std::size_t leaf) {
    return work.bounds[leaf] < std::max(a.answers.reach(chunk), b.answers.reach_of_leaf(leaf));
  };
  work.nearest.clear();
  for (std::size_t leaf = 0; leaf < work.bounds.size(); ++leaf) {
    if (in_reach(leaf)) {  // bounds are not negative: their bits are in the order of their values
      work.nearest.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(work.bounds[leaf])} << 32U | leaf);
    }
  }
  std::sort(work.nearest.begin(), work.nearest.end());
  std::array<float, internal::kChunks> of_chunks;
  for (const std::uint64_t key : work.nearest) {
    const std::size_t leaf = key & 0xFFFFFFFFU;
    if (!in_reach(leaf)) {
      continue;
    }
    b.leaves.bounds_to_chunks(a.leaves, chunk, leaf, of_chunks.data());
    const std::size_t end = std::min(b.leaves.chunks(), (leaf + 1) * internal::kChunks);
    for (std::size_t other = leaf * internal::kChunks; other < end; ++other) {
      if (of_chunks[other % internal::kChunks] < std::max(a.answers.reach(chunk), b.answers.reach(other))) {
        meet(a, chunk, b, other);
      }
    }
  }
}

/// Both directions in one pass: each thread takes leaves of the source and keeps answers of its own for the target.
/// Whoever compares two places, the two nearest are the same.
void search(const internal::PcaBuckets& source, internal::NearestAnswers& forward, const internal::PcaBuckets& target,
            internal::NearestAnswers& backward) {
  std::vector<internal::NearestAnswers> parts(std::max<std::size_t>(1, std::min(source.leaves(), thread_count())),
                                              backward);
  std::atomic<std::size_t> next{0};
  parallel_for(parts.size(), [&](std::size_t part) {
    Workspace work;
    for (std::size_t leaf = next++; leaf < source.leaves(); leaf = next++) {
      for (std::size_t chunk = leaf * internal::kChunks;
           chunk < std::min(source.chunks(), (leaf + 1) * internal::kChunks); ++chunk) {
        search_chunk({source, forward}, chunk, {target, parts[part]}, work);
      }
    }
  });
  for (const internal::NearestAnswers& part : parts) {
    backward.take(part);
  }
}

}  // namespace

TwoWayNearest nearest_two(const search::DescriptorMatrix& source, const search::DescriptorMatrix& target) {
  TwoWayNearest out;
  out.forward.resize(static_cast<std::size_t>(source.rows()));
  out.backward.resize(static_cast<std::size_t>(target.rows()));
  if (source.rows() == 0 || target.rows() == 0) {
    return out;
  }
  if (source.cols() != target.cols()) {
    throw std::invalid_argument("nearest_two: descriptors of different length");
  }
  const internal::PrincipalFrame frame = internal::PrincipalFrame::of(source, target);
  const std::array<const search::DescriptorMatrix*, 2> given = {&source, &target};
  std::array<search::DescriptorMatrix, 2> rotated;
  std::array<double, 2> longest;
  parallel_for(2, [&](std::size_t i) {
    rotated[i] = frame.rotated(*given[i]);
    longest[i] = internal::longest_row(rotated[i]);
  });
  const auto scale =
      internal::WholeNumbers::of(static_cast<std::size_t>(source.cols()), std::max(longest[0], longest[1]));
  std::array<internal::PcaBuckets, 2> leaves;
  parallel_for(2, [&](std::size_t i) { leaves[i] = internal::PcaBuckets(*given[i], rotated[i], scale); });
  if (leaves[0].size() == 0 || leaves[1].size() == 0) {
    return out;
  }
  internal::NearestAnswers forward = start(leaves[0], leaves[1], scale);
  internal::NearestAnswers backward = start(leaves[1], leaves[0], scale);
  search(leaves[0], forward, leaves[1], backward);
  forward.write(out.forward);
  backward.write(out.backward);
  return out;
}

}  // namespace loopmark::matching
