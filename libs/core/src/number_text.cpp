// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/number_text.hpp"

#include <locale.h>  // NOLINT: uselocale is POSIX
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace loopmark {
namespace {

/// This thread speaks C while it lives.
class PlainLocale {
 public:
  PlainLocale() : before_(::uselocale(plain())) {}
  ~PlainLocale() { ::uselocale(before_); }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

 private:
  static locale_t plain() {
    static const locale_t locale = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return locale;
  }
  locale_t before_;
};

}  // namespace

std::string format_text(const char* form, ...) {
  const PlainLocale here;
  std::va_list arguments;
  std::va_list again;
  va_start(arguments, form);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, form, arguments);
  va_end(arguments);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  std::vsnprintf(text.data(), text.size() + 1, form, again);
  va_end(again);
  return text;
}

std::string exact_text(double value) {
  std::string text = std::signbit(value) ? "-" : "";
  char digits[40];
  const auto end = std::to_chars(digits, digits + sizeof digits, std::abs(value), std::chars_format::hex).ptr;
  return text + (std::isfinite(value) ? "0x" : "") + std::string(digits, end);
}

std::optional<double> number_in(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) {
    text.remove_prefix(1);
  }
  const bool exact = text.starts_with("0x");
  if (exact) {
    text.remove_prefix(2);
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value,
                                            exact ? std::chars_format::hex : std::chars_format::general);
  if (error != std::errc() || end != text.data() + text.size() || text.starts_with('-')) {
    return std::nullopt;
  }
  return negative ? -value : value;
}

}  // namespace loopmark
