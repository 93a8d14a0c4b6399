// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Numbers as text, with a point and nothing else whatever locale the host program has set.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace loopmark {

/// As printf has it in the C locale, of any length.
std::string format_text(const char* form, ...) __attribute__((format(printf, 1, 2)));

/// Every bit of a number, as printf's %a has it: "0x1.8p+3".
std::string exact_text(double value);

/// A decimal or an exact number, "nan" and "inf" included; nothing when `text` is none, or more than one.
std::optional<double> number_in(std::string_view text);

}  // namespace loopmark
