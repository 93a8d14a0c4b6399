// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The chunks that were decompressed last, shared by all threads that read a recording.
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace loopmark::recordings::internal {

class BlockCache {
 public:
  using Block = std::shared_ptr<const std::string>;

  /// The block called `key`, made by `make` where it is not there. One thread makes it, others that ask wait. An
  /// exception of `make` reaches all of them, and the block is forgotten.
  Block get(std::uint64_t key, const std::function<std::string()>& make);

 private:
  struct Entry {
    std::uint64_t key = 0;
    std::shared_future<Block> block;
  };
  void forget_old();

  std::mutex mutex_;
  std::list<Entry> entries_;  // the one used last in front
};

}  // namespace loopmark::recordings::internal
