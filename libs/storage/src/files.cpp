// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <locale>
#include <vector>

#include "file_sink.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/storage/sha256.hpp"

namespace loopmark::storage {
namespace {

constexpr std::size_t kPartBytes = 1U << 18U;  // of a file, in memory at a time

/// False, with errno, when the content did not reach the disk: some file systems find out only then that they are full.
bool flush_to_disk(const std::filesystem::path& path, int (*flush)(int)) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return false;
  }
  const bool done = flush(file) == 0 || errno == EINVAL || errno == ENOSYS;  // this file system cannot
  const int problem = errno;
  ::close(file);
  errno = problem;
  return done;
}

void flush_or_throw(const std::filesystem::path& path, int (*flush)(int)) {
  if (!flush_to_disk(path, flush)) {
    throw InputError(path.string(), "", std::string("cannot write to the disk: ") + std::strerror(errno),
                     "check the disk and its space");
  }
}

/// A file that is read; closes itself.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path) : path_(path) {
    while ((file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) < 0 && errno == EINTR) {
      check_interrupt();
    }
    if (file_ < 0) {
      fail(errno);
    }
  }
  ~Descriptor() { ::close(file_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Bytes read, 0 at the end.
  std::size_t read(char* into, std::size_t count) const {
    ssize_t got = 0;
    while ((got = ::read(file_, into, count)) < 0 && errno == EINTR) {
      check_interrupt();
    }
    if (got < 0) {
      fail(errno);
    }
    return static_cast<std::size_t>(got);
  }

  /// As the file system tells it; 0 for pipes.
  std::size_t size() const {
    struct stat status {};
    return ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
  }

 private:
  [[noreturn]] void fail(int error) const {
    throw InputError(path_.string(), "", std::string("cannot read: ") + std::strerror(error),
                     error == EMFILE || error == ENFILE ? "allow more open files (ulimit -n)" : "");
  }

  const std::filesystem::path& path_;
  int file_ = -1;
};

}  // namespace

void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  const std::filesystem::path temporary = path.string() + ".tmp";
  const auto forget = [&] {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
  };
  const auto fail = [&](int error) {
    forget();
    throw InputError(path.string(), "", std::string("cannot write: ") + std::strerror(error),
                     error == EMFILE || error == ENFILE ? "allow more open files (ulimit -n)"
                                                        : "check the disk's space and the folder's rights");
  };
  forget();
  internal::FileSink sink(temporary);
  std::ostream stream(&sink);
  stream.imbue(std::locale::classic());
  try {
    write(stream);
  } catch (...) {
    forget();
    throw;
  }
  if (!sink.finish()) {
    fail(sink.error());
  }
  if (!stream) {
    fail(EIO);
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) {
    fail(errno);
  }
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  write_file_atomically(
      path, [&](std::ostream& stream) { stream.write(content.data(), static_cast<std::streamsize>(content.size())); });
}

std::filesystem::path make_private_folder(const std::filesystem::path& base, const std::string& prefix) {
  std::string name = (base / (prefix + "XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw InputError(base.string(), "", std::string("no folder can be made in it: ") + std::strerror(errno),
                     "set TMPDIR to a folder that can be written");
  }
  return name;
}

void sync_folder(const std::filesystem::path& folder) { flush_or_throw(folder, ::fsync); }
void sync_file_system(const std::filesystem::path& folder) { flush_or_throw(folder, ::syncfs); }

std::string read_file(const std::filesystem::path& path, std::size_t most_bytes) {
  const Descriptor file(path);
  std::string content;
  content.reserve(std::min(file.size(), most_bytes) + 1);
  std::vector<char> part(kPartBytes);
  for (std::size_t got = 0; (got = file.read(part.data(), part.size())) > 0;) {
    if (got > most_bytes - content.size()) {
      throw InputError(path.string(), "", "is larger than " + std::to_string(most_bytes >> 20U) + " MiB",
                       "is this the file that was meant?");
    }
    content.append(part.data(), got);
  }
  return content;
}

std::string sha256_hex(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.hex();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  const Descriptor file(path);
  std::vector<char> part(kPartBytes);
  Sha256 sum;
  for (std::size_t got = 0; (got = file.read(part.data(), part.size())) > 0;) {
    sum.add({part.data(), got});
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
