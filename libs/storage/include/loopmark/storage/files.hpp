// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>

namespace loopmark::storage {

/// Writes a file whole or not at all: `write` fills a temporary file beside `path`, which is then flushed
/// and renamed. Throws InputError naming the file when it cannot be written (full disk, read-only folder).
void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// The same for content that is already there.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// The whole file as bytes. Throws InputError naming the file when it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// SHA-256 of bytes, and of a file's content, as 64 hexadecimal digits (FIPS 180-4).
std::string sha256_hex(std::string_view bytes);
std::string sha256_of_file(const std::filesystem::path& path);

/// CRC-32 (IEEE 802.3) of bytes; `seed` continues an earlier one.
std::uint32_t crc32(std::string_view bytes, std::uint32_t seed = 0);

}  // namespace loopmark::storage
