// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <mutex>
#include <utility>

namespace loopmark::localization::internal {

/// Values kept by number, those used longest ago dropped first. Calls may come from several threads.
template <class Value>
class LruCache {
 public:
  explicit LruCache(std::size_t capacity) : capacity_(capacity) {}

  /// The value of `key`, made where it is not there (outside the lock: two threads may make it at the same time).
  template <class Make>
  Value get(std::size_t key, const Make& make) {
    {
      const std::scoped_lock lock(mutex_);
      if (const auto found = values_.find(key); found != values_.end()) {
        order_.splice(order_.begin(), order_, found->second.second);
        return found->second.first;
      }
    }
    Value value = make();
    const std::scoped_lock lock(mutex_);
    if (values_.count(key) == 0) {
      order_.push_front(key);
      values_.emplace(key, std::pair(value, order_.begin()));
      if (values_.size() > capacity_) {
        values_.erase(order_.back());
        order_.pop_back();
      }
    }
    return value;
  }

 private:
  std::size_t capacity_;
  std::mutex mutex_;
  std::list<std::size_t> order_;
  std::map<std::size_t, std::pair<Value, std::list<std::size_t>::iterator>> values_;
};

}  // namespace loopmark::localization::internal
