// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Names that others chose, made safe to show: a terminal obeys the control characters in them.
#pragma once

#include <string>
#include <string_view>

namespace loopmark {

/// Whether the bytes are UTF-8 (RFC 3629).
bool is_utf8(std::string_view text);

/// The text with control characters (but line feeds and tabs) and bytes that are not UTF-8 as "\x1b".
std::string printable(std::string_view text);

/// Bytes as hexadecimal digits, two each, and back. Throws InputError on digits that are none.
std::string hex_of(std::string_view bytes);
std::string bytes_of_hex(std::string_view digits);

}  // namespace loopmark
