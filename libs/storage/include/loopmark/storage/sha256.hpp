// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace loopmark::storage {

using Sha256State = std::array<std::uint32_t, 8>;

/// SHA-256 (FIPS 180-4) of bytes that come in parts.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// 64 hexadecimal digits. Nothing can be added after this.
  std::string hex();

 private:
  Sha256State state_;
  std::array<unsigned char, 64> block_{};
  std::uint64_t size_ = 0;
};

/// What a block of 64 bytes does to the state, `count` blocks in a row: plainly, and with the processor's own
/// instructions. `sha256_blocks` takes the faster one that the processor has.
void sha256_blocks_plain(Sha256State& state, const unsigned char* data, std::size_t count);
void sha256_blocks(Sha256State& state, const unsigned char* data, std::size_t count);

}  // namespace loopmark::storage
