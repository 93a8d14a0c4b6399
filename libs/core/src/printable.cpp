// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/printable.hpp"

#include <algorithm>
#include <cstdint>

#include "loopmark/core/error.hpp"

namespace loopmark {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";

std::uint32_t byte(std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); }

/// Bytes of the character at `at`, and its number; 0 bytes where none is.
struct Character {
  std::size_t bytes = 0;
  std::uint32_t number = 0;
};

Character character(std::string_view text, std::size_t at) {
  const std::uint32_t first = byte(text, at);
  if (first < 0x80U) {
    return {1, first};
  }
  const std::size_t count = first >= 0xf0U ? 4 : first >= 0xe0U ? 3 : 2;
  if (first < 0xc2U || first > 0xf4U || text.size() - at < count) {
    return {};
  }
  std::uint32_t number = first & (0x7fU >> count);
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(text, at + i) & 0xc0U) != 0x80U) {
      return {};
    }
    number = number << 6U | (byte(text, at + i) & 0x3fU);
  }
  const bool short_enough = number >= (count == 4 ? 0x10000U : count == 3 ? 0x800U : 0x80U);
  const bool surrogate = number >= 0xd800U && number <= 0xdfffU;
  return short_enough && !surrogate && number <= 0x10ffffU ? Character{count, number} : Character{};
}

bool is_control(std::uint32_t c) { return (c < 0x20U && c != '\n' && c != '\t') || (c >= 0x7fU && c < 0xa0U); }

}  // namespace

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = character(text, at).bytes;
    if (bytes == 0) {
      return false;
    }
    at += bytes;
  }
  return true;
}

std::string printable(std::string_view text) {
  std::string safe;
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character(text, at);
    const std::size_t bytes = std::max<std::size_t>(1, c.bytes);
    const bool good = c.bytes > 0 && !is_control(c.number);
    for (std::size_t i = at; i < at + bytes; ++i) {
      safe += good ? std::string(1, text[i]) : "\\x" + hex_of(text.substr(i, 1));
    }
    at += bytes;
  }
  return safe;
}

std::string hex_of(std::string_view bytes) {
  std::string digits;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    digits += kDigits[byte(bytes, i) >> 4U];
    digits += kDigits[byte(bytes, i) & 15U];
  }
  return digits;
}

std::string bytes_of_hex(std::string_view digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    const std::size_t high = kDigits.find(digits[i]);
    const std::size_t low = kDigits.find(digits[i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos) {
      break;
    }
    bytes += static_cast<char>(high << 4U | low);
  }
  if (2 * bytes.size() != digits.size()) {
    throw InputError("'" + std::string(digits.substr(0, 40)) + "' are no hexadecimal digits");
  }
  return bytes;
}

}  // namespace loopmark
