// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace loopmark::io::internal {

/// How many float32 values one point of a .bin file has, told by the values themselves: x, y, z, intensity, ring and
/// time are distributed unlike each other, so that the stream of values repeats its kinds with the period of a point.
/// Nothing where no period from 3 to 6 stands out.
std::optional<std::size_t> columns_shown_by(std::span<const char> bytes);

}  // namespace loopmark::io::internal
