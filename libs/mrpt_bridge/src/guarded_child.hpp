// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Work on bytes that may be hostile, done by code that allocates what they claim.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace loopmark::mrpt_bridge::internal {

/// What `work` returns, from a process of its own that may take `memory_bytes` more than this one has; beyond that its
/// allocations fail (std::bad_alloc). Nothing when that process died. `work` must not throw, and must not wait for
/// other threads: only the calling one is there.
std::optional<std::string> in_guarded_child(std::size_t memory_bytes, const std::function<std::string()>& work);

}  // namespace loopmark::mrpt_bridge::internal
