// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace loopmark::report::internal {

/// &, <, >, " as entities.
std::string escape_markup(const std::string& text);

/// RFC 4648 with padding.
std::string base64(const std::string& bytes);

/// "data:image/png;base64,...".
std::string png_data_uri(const std::string& png);

/// A number with a fixed count of decimals, "-0.0" as "0.0".
std::string fixed(double value, int decimals);

/// A coordinate in a drawing: at most two decimals, no trailing zeros.
std::string coordinate(double value);

}  // namespace loopmark::report::internal
