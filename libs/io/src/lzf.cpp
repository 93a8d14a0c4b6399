// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_formats.hpp"

#include <cstring>

namespace loopmark::io::internal {

bool lzf_decompress(std::span<const char> in, std::span<char> out) {
  std::size_t i = 0;
  std::size_t o = 0;
  const auto byte = [&in](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(in[at])); };
  while (i < in.size()) {
    const std::size_t control = byte(i++);
    if (control < 32) {  // a run of control + 1 literal bytes
      const std::size_t run = control + 1;
      if (i + run > in.size() || o + run > out.size()) {
        return false;
      }
      std::memcpy(out.data() + o, in.data() + i, run);
      i += run;
      o += run;
      continue;
    }
    // A copy of earlier output: 3 bits of length, 13 bits of distance; length 7 is continued in a byte.
    std::size_t length = control >> 5U;
    if (i + (length == 7 ? 2 : 1) > in.size()) {
      return false;
    }
    if (length == 7) {
      length += byte(i++);
    }
    length += 2;
    const std::size_t distance = ((control & 31U) << 8U) + byte(i++) + 1;
    if (distance > o || o + length > out.size()) {
      return false;
    }
    for (std::size_t k = 0; k < length; ++k, ++o) {  // may overlap what it copies
      out[o] = out[o - distance];
    }
  }
  return o == out.size();
}

}  // namespace loopmark::io::internal
