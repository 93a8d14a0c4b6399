// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/sha256.hpp"

namespace loopmark::storage {
namespace {

constexpr std::size_t kPartBytes = 1U << 18U;  // of a file, in memory at a time

/// False, with errno, when the content did not reach the disk: some file systems find out only then that they are full.
bool flush_to_disk(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return false;
  }
  const bool done = ::fsync(file) == 0 || errno == EINVAL;  // EINVAL: this file system cannot
  const int problem = errno;
  ::close(file);
  errno = problem;
  return done;
}

}  // namespace

void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  const std::filesystem::path temporary = path.string() + ".tmp";
  const auto forget = [&] {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
  };
  const auto fail = [&](const std::string& reason) {
    forget();
    throw InputError(path.string(), "", "cannot write: " + reason, "check the disk's space and the folder's rights");
  };
  errno = 0;
  std::ofstream stream(temporary, std::ios::binary);
  if (!stream) {
    fail(std::strerror(errno));
  }
  try {
    write(stream);
  } catch (...) {
    forget();
    throw;
  }
  stream.close();
  if (!stream) {
    fail(errno != 0 ? std::strerror(errno) : "the stream failed");
  }
  if (!flush_to_disk(temporary)) {
    fail(std::strerror(errno));
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) {
    fail(error.message());
  }
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  write_file_atomically(
      path, [&](std::ostream& stream) { stream.write(content.data(), static_cast<std::streamsize>(content.size())); });
}

std::string read_file(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  if (!stream || std::filesystem::is_directory(path)) {
    throw InputError(path.string(), "", std::string("cannot read: ") + std::strerror(errno != 0 ? errno : EISDIR));
  }
  content << stream.rdbuf();
  return std::move(content).str();
}

std::string sha256_hex(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.hex();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> part(kPartBytes);
  Sha256 sum;
  while (stream && !std::filesystem::is_directory(path)) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    sum.add({part.data(), static_cast<std::size_t>(stream.gcount())});
  }
  if (!stream.eof()) {
    throw InputError(path.string(), "", std::string("cannot read: ") + std::strerror(errno != 0 ? errno : EISDIR));
  }
  return sum.hex();
}

std::uint32_t crc32(std::string_view bytes, std::uint32_t seed) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> entries{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) {
        value = (value & 1U) != 0 ? 0xedb88320U ^ (value >> 1U) : value >> 1U;
      }
      entries[i] = value;
    }
    return entries;
  }();
  std::uint32_t crc = ~seed;
  for (const char byte : bytes) {
    crc = table[(crc ^ static_cast<unsigned char>(byte)) & 255U] ^ (crc >> 8U);
  }
  return ~crc;
}

}  // namespace loopmark::storage
