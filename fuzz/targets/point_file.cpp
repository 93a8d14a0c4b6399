// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <span>

#include "point_formats.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

/// The first byte says what the rest is.
void point_file(std::string_view bytes) {
  if (bytes.empty()) {
    return;
  }
  const auto kind = static_cast<unsigned char>(bytes[0]) % 5U;
  const std::span<const char> body(bytes.data() + 1, bytes.size() - 1);
  reading([&] {
    switch (kind) {
      case 0:
        io::internal::read_pcd(body, "fuzz.pcd", {});
        break;
      case 1:
        io::internal::read_ply(body, "fuzz.ply", {});
        break;
      default:
        io::internal::read_bin(body, kind + 2U, "fuzz.bin", {});
    }
  });
}

}  // namespace loopmark::fuzz
