// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace loopmark::web_page {

/// The script and style of all pages, embedded when the program was built.
struct Bundle {
  std::string_view script;
  std::string_view style;
  std::string_view licences;  ///< of the packages in the script
  std::string_view problem;   ///< why there is no script; empty where there is one
};

const Bundle& bundle();

}  // namespace loopmark::web_page
