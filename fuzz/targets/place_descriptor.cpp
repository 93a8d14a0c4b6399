// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/places/place_descriptor.hpp"

#include "loopmark/storage/files.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

void place_descriptor(std::string_view bytes) {
  const std::uint32_t checksum = storage::crc32(bytes);
  const std::string sealed = std::string(bytes) + std::string(reinterpret_cast<const char*>(&checksum), 4);
  reading([&] { places::require_sound(places::PlaceDescriptor::from_bytes(sealed), {}); });
}

}  // namespace loopmark::fuzz
