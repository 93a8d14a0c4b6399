// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Parallel loops whose results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace loopmark {

/// Bounds the threads of all parallel loops of this process; 0: one for each core. Returns the number in force.
std::size_t set_thread_count(std::size_t threads);

/// The number of threads in force.
std::size_t thread_count();

/// Calls body(i) for each i in [0, count), in any order and on any thread. The bodies must not touch
/// each other's data. `grain` is the least number of neighbouring indices done by one task.
/// The first exception thrown by a body is rethrown here.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, std::size_t grain = 1);

/// Calls body(begin, end) for consecutive blocks of `block` indices (the last may be shorter). The blocks
/// depend on `count` and `block` only, never on the number of threads.
void parallel_blocks(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body);

/// Maps blocks of [0, count) in parallel, then folds the partial results in block order: the same
/// bytes at any number of threads. map(begin, end) -> T; fold(T& total, const T& part).
template <class T, class Map, class Fold>
T parallel_reduce_ordered(std::size_t count, std::size_t block, T total, const Map& map, const Fold& fold) {
  if (count == 0) {
    return total;
  }
  std::vector<T> parts((count + block - 1) / block, total);
  parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) { parts[begin / block] = map(begin, end); });
  for (const T& part : parts) {
    fold(total, part);
  }
  return total;
}

}  // namespace loopmark
