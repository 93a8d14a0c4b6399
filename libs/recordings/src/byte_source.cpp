// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

#include "loopmark/recordings/recording.hpp"

namespace loopmark::recordings::internal {
namespace {

constexpr std::size_t kWindow = std::size_t{64} << 10U;

}  // namespace

ByteSource::ByteSource(const std::filesystem::path& file) : path_(file) {
  handle_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat facts {};
  if (handle_ < 0 || ::fstat(handle_, &facts) != 0) {
    const std::string why = std::strerror(errno);
    if (handle_ >= 0) {
      ::close(handle_);
    }
    throw InputError(file.string(), "", "cannot be read: " + why);
  }
  size_ = static_cast<std::uint64_t>(facts.st_size);
}

ByteSource::~ByteSource() { ::close(handle_); }

std::size_t ByteSource::read(std::uint64_t offset, char* out, std::size_t count) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(handle_, out + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      throw InputError(path_.string(), "byte " + std::to_string(offset + done),
                       std::string("cannot be read: ") + std::strerror(errno));
    }
    if (got == 0) {
      break;
    }
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::string ByteSource::exactly(std::uint64_t offset, std::uint64_t count) const {
  const std::string place = "byte " + std::to_string(offset);
  if (count > kMostBytes) {
    throw InputError(path_.string(), place,
                     "a record of " + std::to_string(count) + " bytes, more than the " + std::to_string(kMostBytes) +
                         " that are read at once");
  }
  if (offset > size_ || count > size_ - offset) {
    throw InputError(path_.string(), place, "the file ends within a record of " + std::to_string(count) + " bytes",
                     "it was cut off; copy it again");
  }
  std::string bytes(static_cast<std::size_t>(count), '\0');
  if (read(offset, bytes.data(), bytes.size()) != bytes.size()) {
    throw InputError(path_.string(), place, "the file became shorter while it was read");
  }
  return bytes;
}

std::string_view Window::at(std::uint64_t offset, std::size_t count) {
  const bool there = offset >= begin_ && offset + count <= begin_ + filled_;
  if (!there) {
    const std::uint64_t left = offset < source_.size() ? source_.size() - offset : 0;
    const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(left, std::max(count, kWindow)));
    if (bytes_.size() < wanted) {
      bytes_.resize(wanted);
    }
    filled_ = source_.read(offset, bytes_.data(), wanted);
    begin_ = offset;
  }
  const auto skip = static_cast<std::size_t>(offset - begin_);
  return {bytes_.data() + skip, std::min(count, filled_ - std::min(skip, filled_))};
}

std::string_view Taker::bytes(std::uint64_t count) {
  if (!ok || count > rest.size()) {
    ok = false;
    return {};
  }
  const std::string_view taken = rest.substr(0, static_cast<std::size_t>(count));
  rest.remove_prefix(static_cast<std::size_t>(count));
  return taken;
}

std::string first_bytes(const std::filesystem::path& file, std::size_t count) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(count, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(in.gcount() > 0 ? static_cast<std::size_t>(in.gcount()) : 0);
  return bytes;
}

}  // namespace loopmark::recordings::internal
