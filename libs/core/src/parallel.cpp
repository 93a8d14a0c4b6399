// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/parallel.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

namespace loopmark {
namespace {

std::unique_ptr<tbb::global_control>& control() {
  static std::unique_ptr<tbb::global_control> instance;
  return instance;
}

}  // namespace

std::size_t set_thread_count(std::size_t threads) {
  if (threads == 0) {
    threads = static_cast<std::size_t>(tbb::info::default_concurrency());
  }
  control() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
  return threads;
}

std::size_t thread_count() { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); }

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, std::size_t grain) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(grain, 1)),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        body(i);
                      }
                    });
}

void parallel_blocks(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t blocks = (count + block - 1) / block;
  parallel_for(blocks, [&](std::size_t b) { body(b * block, std::min(count, (b + 1) * block)); });
}

}  // namespace loopmark
