// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::features::internal {

/// A two-dimensional NumPy array of numbers (format versions 1 to 3, C or Fortran order, float16/32/64 or integers) as
/// floats. Throws InputError naming `file` and `place`, also when a number is not finite.
search::DescriptorMatrix parse_npy(std::string_view bytes, const std::string& file, const std::string& place);

/// Whether the array is one of int8: quantised descriptors.
bool is_int8(std::string_view npy);

}  // namespace loopmark::features::internal
