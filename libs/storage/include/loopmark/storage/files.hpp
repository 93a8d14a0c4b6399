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
/// and renamed; a link in its place is never followed. The stream knows no locale but the classic one.
/// Throws InputError naming the file when it cannot be written (full disk, read-only folder).
void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// The same for content that is already there.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// A new folder below `base` with a name that cannot be guessed, for this user alone. Throws InputError.
std::filesystem::path make_private_folder(const std::filesystem::path& base, const std::string& prefix);

/// Makes new, renamed and removed names of a folder last a power cut. Throws InputError naming the folder.
void sync_folder(const std::filesystem::path& folder);

/// The same for all that was written on the file system that the folder is on: files, names, everything.
void sync_file_system(const std::filesystem::path& folder);

/// The whole file as bytes. Throws InputError naming the file when it cannot be read or is larger than `most_bytes`,
/// and Interrupted when the user asks to stop while a pipe is waited for.
std::string read_file(const std::filesystem::path& path, std::size_t most_bytes = std::size_t{1} << 32U);

/// SHA-256 of bytes, and of a file's content, as 64 hexadecimal digits (FIPS 180-4).
std::string sha256_hex(std::string_view bytes);
std::string sha256_of_file(const std::filesystem::path& path);

/// CRC-32 (IEEE 802.3) of bytes; `seed` continues an earlier one.
std::uint32_t crc32(std::string_view bytes, std::uint32_t seed = 0);

}  // namespace loopmark::storage
