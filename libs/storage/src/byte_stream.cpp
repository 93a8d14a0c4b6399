// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/byte_stream.hpp"

#include <cstdint>

#include "loopmark/storage/files.hpp"

namespace loopmark::storage {

std::string sealed(const std::string& content) {
  ByteWriter writer;
  writer.value(crc32(content));
  writer.text(content);
  return writer.bytes();
}

std::string unsealed(const std::string& bytes, const std::string& what) {
  ByteReader reader(bytes);
  const auto checksum = reader.value<std::uint32_t>();
  std::string content = reader.text();
  if (crc32(content) != checksum) {
    throw InputError(what + " is damaged");
  }
  return content;
}

}  // namespace loopmark::storage
