// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "file_sink.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace loopmark::storage::internal {

FileSink::FileSink(const std::filesystem::path& path)
    : file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666)) {
  error_ = file_ < 0 ? errno : 0;
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

FileSink::~FileSink() {
  if (file_ >= 0) {
    ::close(file_);
  }
}

bool FileSink::put(const char* bytes, std::size_t count) {
  while (count > 0 && error_ == 0) {
    const ssize_t written = ::write(file_, bytes, count);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      error_ = written < 0 ? errno : EIO;
      break;
    }
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
  return error_ == 0;
}

bool FileSink::flush() {
  const bool good = put(pbase(), static_cast<std::size_t>(pptr() - pbase()));
  setp(buffer_.data(), buffer_.data() + buffer_.size());
  return good;
}

FileSink::int_type FileSink::overflow(int_type letter) {
  if (!flush()) {
    return traits_type::eof();
  }
  if (!traits_type::eq_int_type(letter, traits_type::eof())) {
    *pptr() = traits_type::to_char_type(letter);
    pbump(1);
  }
  return traits_type::not_eof(letter);
}

std::streamsize FileSink::xsputn(const char* text, std::streamsize count) {
  if (count < epptr() - pptr()) {
    return std::streambuf::xsputn(text, count);
  }
  return flush() && put(text, static_cast<std::size_t>(count)) ? count : 0;
}

bool FileSink::finish() {
  if (flush() && ::fsync(file_) != 0 && errno != EINVAL) {  // EINVAL: this file system cannot
    error_ = errno;
  }
  const int file = file_;
  file_ = -1;
  if (file >= 0 && ::close(file) != 0 && error_ == 0) {
    error_ = errno;
  }
  return error_ == 0;
}

}  // namespace loopmark::storage::internal
