// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Finds places that look alike among all keyframes of a map, with no idea of where they are.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "loopmark/places/place_descriptor.hpp"

namespace loopmark::places {

struct PlaceMatch {
  std::size_t id = 0;     ///< as given to add()
  double distance = 0.0;  ///< of the descriptors
};

/// Exact up to a few thousand places; beyond that an inverted file: descriptors projected to 64 numbers and sorted into
/// cells around k-means centres, of which a query looks into the nearest, then compares the best candidates in full.
/// The answers depend on the order of add() only.
class PlaceIndex {
 public:
  PlaceIndex();
  ~PlaceIndex();
  PlaceIndex(PlaceIndex&&) noexcept;
  PlaceIndex& operator=(PlaceIndex&&) noexcept;

  /// Throws std::invalid_argument when the descriptor's size differs from those before.
  void add(std::size_t id, const PlaceDescriptor& descriptor);

  /// The k most alike places, nearest first (equals by order of add). `accept` may leave places out: those just passed.
  std::vector<PlaceMatch> query(const PlaceDescriptor& descriptor, std::size_t k,
                                const std::function<bool(std::size_t id)>& accept = {}) const;

  /// The same by comparing with every place.
  std::vector<PlaceMatch> query_exactly(const PlaceDescriptor& descriptor, std::size_t k,
                                        const std::function<bool(std::size_t id)>& accept = {}) const;

  std::size_t size() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace loopmark::places
