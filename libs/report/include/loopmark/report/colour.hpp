// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace loopmark::report {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  bool operator==(const Colour&) const = default;
};

inline constexpr Colour kWhite{255, 255, 255};
inline constexpr Colour kInk{34, 34, 34};
inline constexpr Colour kGrey{140, 140, 140};

/// Colours of the series of a plot, told apart by readers with any colour vision (Okabe and Ito); repeats after 8.
Colour palette(std::size_t index);

/// A colour for a value in [0, 1] (clamped), dark blue over green to yellow, growing in lightness all along (after
/// Viridis by Smith and van der Walt, interpolated between 9 of its colours).
Colour heat_colour(double value);

/// Between a (at 0) and b (at 1).
Colour mix(Colour a, Colour b, double ratio);

/// "#rrggbb".
std::string hex(Colour colour);

}  // namespace loopmark::report
