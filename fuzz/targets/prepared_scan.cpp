// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "loopmark/registration/engine.hpp"
#include "loopmark/storage/files.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

/// The bytes behind "LMPS", version and checksum.
void prepared_scan(std::string_view bytes) {
  const std::uint32_t version = 1;
  const std::uint32_t checksum = storage::crc32(bytes);
  std::string sealed = "LMPS";
  sealed.append(reinterpret_cast<const char*>(&version), sizeof version);
  sealed.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  sealed += bytes;
  reading([&] { registration::PreparedScan::from_bytes(sealed); });
}

}  // namespace loopmark::fuzz
