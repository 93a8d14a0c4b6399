// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace loopmark::report {
namespace {

std::uint8_t between(std::uint8_t a, std::uint8_t b, double ratio) {
  return static_cast<std::uint8_t>(std::lround((1.0 - ratio) * a + ratio * b));
}

}  // namespace

Colour palette(std::size_t index) {
  constexpr std::array<Colour, 8> kColours = {{{0, 114, 178},
                                               {213, 94, 0},
                                               {0, 158, 115},
                                               {204, 121, 167},
                                               {230, 159, 0},
                                               {86, 180, 233},
                                               {90, 60, 140},
                                               {80, 80, 80}}};
  return kColours[index % kColours.size()];
}

Colour heat_colour(double value) {
  constexpr std::array<Colour, 9> kStops = {{{68, 1, 84},
                                             {71, 44, 122},
                                             {59, 81, 139},
                                             {44, 113, 142},
                                             {33, 144, 141},
                                             {39, 173, 129},
                                             {92, 200, 99},
                                             {170, 220, 50},
                                             {253, 231, 37}}};
  const double place = std::clamp(value, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t stop = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  return mix(kStops[stop], kStops[stop + 1], place - static_cast<double>(stop));
}

Colour mix(Colour a, Colour b, double ratio) {
  ratio = std::clamp(ratio, 0.0, 1.0);
  return {between(a.red, b.red, ratio), between(a.green, b.green, ratio), between(a.blue, b.blue, ratio)};
}

std::string hex(Colour colour) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t channel : {colour.red, colour.green, colour.blue}) {
    text += kDigits[channel >> 4U];
    text += kDigits[channel & 15U];
  }
  return text;
}

}  // namespace loopmark::report
