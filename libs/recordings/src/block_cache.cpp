// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "block_cache.hpp"

#include <algorithm>
#include <chrono>

namespace loopmark::recordings::internal {
namespace {

constexpr std::size_t kMostBlocks = 16;
constexpr std::size_t kMostCachedBytes = std::size_t{64} << 20U;

}  // namespace

BlockCache::Block BlockCache::get(std::uint64_t key, const std::function<std::string()>& make) {
  std::promise<Block> promise;
  {
    std::unique_lock lock(mutex_);
    const auto found = std::find_if(entries_.begin(), entries_.end(), [key](const Entry& e) { return e.key == key; });
    if (found != entries_.end()) {
      entries_.splice(entries_.begin(), entries_, found);
      const std::shared_future<Block> block = found->block;
      lock.unlock();
      return block.get();
    }
    entries_.push_front({key, promise.get_future().share()});
  }
  try {
    const auto block = std::make_shared<const std::string>(make());
    promise.set_value(block);
    const std::lock_guard lock(mutex_);
    forget_old();
    return block;
  } catch (...) {
    {
      const std::lock_guard lock(mutex_);
      entries_.remove_if([key](const Entry& e) { return e.key == key; });
    }
    promise.set_exception(std::current_exception());
    throw;
  }
}

void BlockCache::forget_old() {
  std::size_t bytes = 0;
  std::size_t kept = 0;
  for (auto it = entries_.begin(); it != entries_.end();) {
    if (it->block.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      ++it;
      continue;
    }
    bytes += it->block.get()->size();
    ++kept;
    const bool old = kept > 1 && (kept > kMostBlocks || bytes > kMostCachedBytes);
    it = old ? entries_.erase(it) : std::next(it);
  }
}

}  // namespace loopmark::recordings::internal
