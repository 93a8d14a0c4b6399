// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/web_page/bundle.hpp"

namespace loopmark::web_page {
namespace internal {

// Made by cmake/embed_bundle.cmake.
extern const unsigned char kScript[];
extern const unsigned long kScript_size;
extern const unsigned char kStyle[];
extern const unsigned long kStyle_size;
extern const unsigned char kLicences[];
extern const unsigned long kLicences_size;
extern const char* const kProblem;

}  // namespace internal

const Bundle& bundle() {
  const auto text = [](const unsigned char* bytes, unsigned long size) {
    return std::string_view(reinterpret_cast<const char*>(bytes), size);
  };
  static const Bundle all = {text(internal::kScript, internal::kScript_size),
                             text(internal::kStyle, internal::kStyle_size),
                             text(internal::kLicences, internal::kLicences_size), internal::kProblem};
  return all;
}

}  // namespace loopmark::web_page
