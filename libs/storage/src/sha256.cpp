// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/sha256.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "sha256_rounds.hpp"

namespace loopmark::storage {
namespace {

void plain_block(Sha256State& state, const unsigned char* block) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t i = 0; i < 16; ++i) {
    w[i] = static_cast<std::uint32_t>(block[4 * i]) << 24U | static_cast<std::uint32_t>(block[4 * i + 1]) << 16U |
           static_cast<std::uint32_t>(block[4 * i + 2]) << 8U | block[4 * i + 3];
  }
  for (std::size_t i = 16; i < 64; ++i) {
    const std::uint32_t s0 = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ (w[i - 15] >> 3U);
    const std::uint32_t s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ (w[i - 2] >> 10U);
    w[i] = w[i - 16] + s0 + w[i - 7] + s1;
  }
  auto [a, b, c, d, e, f, g, h] = state;
  for (std::size_t i = 0; i < 64; ++i) {
    const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + internal::kSha256Rounds[i] + w[i];
    const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
  }
  const Sha256State add = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) {
    state[i] += add[i];
  }
}

}  // namespace

void sha256_blocks_plain(Sha256State& state, const unsigned char* data, std::size_t count) {
  for (; count > 0; --count, data += 64) {
    plain_block(state, data);
  }
}

void sha256_blocks(Sha256State& state, const unsigned char* data, std::size_t count) {
  static const bool fast = internal::sha256_instructions_present();
  (fast ? internal::sha256_blocks_instructions : sha256_blocks_plain)(state, data, count);
}

Sha256::Sha256()
    : state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19} {}

void Sha256::add(std::string_view bytes) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  std::size_t left = bytes.size();
  const std::size_t held = size_ % 64;
  size_ += left;
  if (held > 0) {
    const std::size_t more = std::min(left, 64 - held);
    std::memcpy(block_.data() + held, data, more);
    if (held + more < 64) {
      return;
    }
    sha256_blocks(state_, block_.data(), 1);
    data += more;
    left -= more;
  }
  sha256_blocks(state_, data, left / 64);
  if (left % 64 > 0) {
    std::memcpy(block_.data(), data + left / 64 * 64, left % 64);
  }
}

std::string Sha256::hex() {
  const std::uint64_t bits = 8 * size_;
  std::string tail(size_ % 64 < 56 ? 64 - size_ % 64 : 128 - size_ % 64, '\0');
  tail[0] = static_cast<char>(0x80);
  for (std::size_t i = 0; i < 8; ++i) {
    tail[tail.size() - 1 - i] = static_cast<char>(bits >> (8 * i) & 255U);
  }
  add(tail);
  std::string hex;
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (const std::uint32_t word : state_) {
    for (int shift = 28; shift >= 0; shift -= 4) {
      hex += kDigits[(word >> static_cast<unsigned>(shift)) & 15U];
    }
  }
  return hex;
}

}  // namespace loopmark::storage
