// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace loopmark::report::internal {

inline constexpr std::size_t kGlyphWidth = 5;
inline constexpr std::size_t kGlyphHeight = 7;

/// A letter's columns from the left; bit 0 is the uppermost pixel.
using Glyph = std::array<std::uint8_t, kGlyphWidth>;

/// The shape of an ASCII letter; of '?' for anything else.
const Glyph& glyph_of(char letter);

}  // namespace loopmark::report::internal
