// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <variant>

#include "loopmark/core/parallel.hpp"
#include "loopmark/matching/nearest_two.hpp"
#include "quantized_products.hpp"

namespace loopmark::matching {
namespace {

using internal::kProductLanes;
using internal::kProductRows;
using internal::kProductStep;

constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
constexpr Eigen::Index kLongest = 32768;  // numbers a row: four times the squares of 127 stay below 2^31
constexpr std::size_t kTaskRows = 16 * internal::kProductRows;

/// Squared distances in whole numbers and whose they are; among equal ones the lower row is nearer.
struct WholeTwo {
  std::int32_t first_squared = kFar;
  std::int32_t second_squared = kFar;
  std::uint32_t first = kNoNeighbour;
  std::uint32_t second = kNoNeighbour;

  void offer(std::int32_t squared, std::uint32_t row) {
    if (std::tie(squared, row) < std::tie(first_squared, first)) {
      second_squared = first_squared;
      second = first;
      first_squared = squared;
      first = row;
    } else if (std::tie(squared, row) < std::tie(second_squared, second)) {
      second_squared = squared;
      second = row;
    }
  }
};

/// Rows padded with zeros to whole groups and a length that the kernels want.
struct PaddedRows {
  PaddedRows(const search::QuantizedDescriptors& rows, std::size_t group)
      : count(static_cast<std::size_t>(rows.rows())),
        length((static_cast<std::size_t>(rows.cols()) + internal::kProductStep - 1) / internal::kProductStep *
               internal::kProductStep),
        padded((count + group - 1) / group * group),
        numbers(padded * length, 0),
        sums(padded, 0),
        norms(padded, 0) {
    const auto columns = static_cast<std::size_t>(rows.cols());
    for (std::size_t r = 0; r < count; ++r) {
      std::copy_n(rows.data() + r * columns, columns, numbers.data() + r * length);
      for (std::size_t i = 0; i < columns; ++i) {
        const std::int32_t x = numbers[r * length + i];
        sums[r] += x;
        norms[r] += x * x;
      }
    }
  }

  std::size_t count;
  std::size_t length;
  std::size_t padded;
  std::vector<std::int8_t> numbers;
  std::vector<std::int32_t> sums;   ///< of the numbers of a row
  std::vector<std::int32_t> norms;  ///< squared lengths; 0: nobody's neighbour
};

/// The order that the kernels want of the target: [group][length / kProductStep][kProductLanes][kProductStep].
std::vector<std::int8_t> interleaved(const PaddedRows& rows) {
  std::vector<std::int8_t> out(rows.numbers.size());
  std::int8_t* to = out.data();
  for (std::size_t first = 0; first < rows.padded; first += internal::kProductLanes) {
    for (std::size_t i = 0; i < rows.length; i += internal::kProductStep) {
      for (std::size_t l = 0; l < internal::kProductLanes; ++l) {
        std::memcpy(to, rows.numbers.data() + (first + l) * rows.length + i, internal::kProductStep);
        to += internal::kProductStep;
      }
    }
  }
  return out;
}

/// One block of products, offered to the rows of both sides.
void offer_block(const std::int32_t* products, const PaddedRows& source, std::size_t a0, const PaddedRows& target,
                 std::size_t b0, std::vector<WholeTwo>& forward, std::vector<WholeTwo>& backward) {
  const std::size_t a_end = std::min(internal::kProductRows, source.count - a0);
  const std::size_t b_end = std::min(internal::kProductLanes, target.count - b0);
  std::array<std::int32_t, internal::kProductLanes> limits;
  for (std::size_t l = 0; l < internal::kProductLanes; ++l) {
    limits[l] = l < b_end ? backward[b0 + l].second_squared : 0;
  }
  for (std::size_t q = 0; q < a_end; ++q) {
    const std::int32_t norm = source.norms[a0 + q];
    const std::int32_t limit = forward[a0 + q].second_squared;
    std::array<std::int32_t, internal::kProductLanes> squared;
    std::int32_t hits = 0;
    for (std::size_t l = 0; l < internal::kProductLanes; ++l) {
      squared[l] = norm + target.norms[b0 + l] - 2 * products[q * internal::kProductLanes + l];
      hits |= static_cast<std::int32_t>(squared[l] <= limit) | static_cast<std::int32_t>(squared[l] <= limits[l]);
    }
    if (hits == 0 || norm == 0) {
      continue;
    }
    for (std::size_t l = 0; l < b_end; ++l) {
      if (target.norms[b0 + l] != 0) {
        forward[a0 + q].offer(squared[l], static_cast<std::uint32_t>(b0 + l));
        backward[b0 + l].offer(squared[l], static_cast<std::uint32_t>(a0 + q));
      }
    }
  }
}

std::vector<NearestTwo> written(const std::vector<WholeTwo>& found) {
  const auto squared = [](std::int32_t whole) {
    return whole == kFar ? std::numeric_limits<float>::infinity() : static_cast<float>(whole);
  };
  std::vector<NearestTwo> out;
  out.reserve(found.size());
  for (const WholeTwo& two : found) {
    out.push_back({two.first, two.second, squared(two.first_squared), squared(two.second_squared)});
  }
  return out;
}

}  // namespace

TwoWayNearest nearest_two(const search::QuantizedDescriptors& source_rows,
                          const search::QuantizedDescriptors& target_rows) {
  if (source_rows.rows() > 0 && target_rows.rows() > 0 && source_rows.cols() != target_rows.cols()) {
    throw std::invalid_argument("nearest_two: descriptors of different length");
  }
  if (source_rows.cols() > kLongest) {
    throw std::invalid_argument("nearest_two: descriptors are too long");
  }
  const PaddedRows source(source_rows, internal::kProductRows);
  const PaddedRows target(target_rows, internal::kProductLanes);
  std::vector<WholeTwo> forward(source.count);
  std::vector<WholeTwo> backward(target.count);
  if (source.count > 0 && target.count > 0) {
    static const internal::QuantizedProducts products_of = internal::quantized_products();
    const std::vector<std::int8_t> lanes = interleaved(target);
    std::vector<std::vector<WholeTwo>> parts((source.count + kTaskRows - 1) / kTaskRows, backward);
    parallel_blocks(source.count, kTaskRows, [&](std::size_t begin, std::size_t end) {
      std::array<std::int32_t, internal::kProductRows * internal::kProductLanes> products;
      for (std::size_t b = 0; b < target.count; b += internal::kProductLanes) {
        for (std::size_t a = begin; a < end; a += internal::kProductRows) {
          products_of(source.numbers.data() + a * source.length, source.sums.data() + a,
                      lanes.data() + b * target.length, source.length, products.data());
          offer_block(products.data(), source, a, target, b, forward, parts[begin / kTaskRows]);
        }
      }
    });
    for (const auto& part : parts) {
      for (std::size_t b = 0; b < target.count; ++b) {
        if (part[b].first != kNoNeighbour) {
          backward[b].offer(part[b].first_squared, part[b].first);
        }
        if (part[b].second != kNoNeighbour) {
          backward[b].offer(part[b].second_squared, part[b].second);
        }
      }
    }
  }
  return {written(forward), written(backward)};
}

TwoWayNearest nearest_two(const search::DescriptorRows& source, const search::DescriptorRows& target) {
  return std::visit(
      [&](const auto& rows) -> TwoWayNearest {
        using Rows = std::decay_t<decltype(rows)>;
        if (const auto* others = std::get_if<Rows>(&target)) {
          return nearest_two(rows, *others);
        }
        const auto others = std::visit([](const auto& m) { return m.rows(); }, target);
        if (rows.rows() > 0 && others > 0) {
          throw std::invalid_argument("nearest_two: quantised descriptors and others");
        }
        return {std::vector<NearestTwo>(static_cast<std::size_t>(rows.rows())),
                std::vector<NearestTwo>(static_cast<std::size_t>(others))};
      },
      source);
}

}  // namespace loopmark::matching
