// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "gz_stream.hpp"

#include <algorithm>
#include <stdexcept>

namespace loopmark::mrpt_bridge::internal {

GzStream::GzStream(const std::filesystem::path& path) : file_(::gzopen(path.c_str(), "rb")) {
  if (file_ == nullptr) {
    throw std::runtime_error("cannot open");
  }
  ::gzbuffer(file_, 1U << 18U);
}

GzStream::~GzStream() { ::gzclose(file_); }

std::size_t GzStream::Read(void* buffer, std::size_t count) {
  auto* at = static_cast<char*>(buffer);
  std::size_t done = 0;
  while (done < count) {
    constexpr std::size_t kMost = 1U << 30U;
    const int got = ::gzread(file_, at + done, static_cast<unsigned>(std::min(count - done, kMost)));
    if (got <= 0) {
      break;
    }
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::size_t GzStream::Write(const void*, std::size_t) { throw std::logic_error("the stream is for reading"); }

std::uint64_t GzStream::Seek(std::int64_t offset, TSeekOrigin origin) {
  if (origin == sFromEnd) {
    throw std::logic_error("the stream's end is not known");
  }
  return static_cast<std::uint64_t>(::gzseek(file_, offset, origin == sFromBeginning ? SEEK_SET : SEEK_CUR));
}

std::uint64_t GzStream::getTotalBytesCount() const { throw std::logic_error("the stream's end is not known"); }

std::uint64_t GzStream::getPosition() const { return static_cast<std::uint64_t>(::gztell(file_)); }

bool GzStream::at_end() {
  const int next = (gzgetc)(file_);
  if (next < 0) {
    return true;
  }
  ::gzungetc(next, file_);
  return false;
}

GzOutput::GzOutput(const std::filesystem::path& path) : file_(::gzopen(path.c_str(), "wb1")) {
  if (file_ == nullptr) {
    throw std::runtime_error("cannot open");
  }
  ::gzbuffer(file_, 1U << 18U);
}

GzOutput::~GzOutput() {
  if (file_ != nullptr) {
    ::gzclose(file_);
  }
}

std::size_t GzOutput::Read(void*, std::size_t) { throw std::logic_error("the stream is for writing"); }

std::size_t GzOutput::Write(const void* buffer, std::size_t count) {
  const auto* at = static_cast<const char*>(buffer);
  for (std::size_t done = 0; done < count;) {
    constexpr std::size_t kMost = 1U << 30U;
    const int put = ::gzwrite(file_, at + done, static_cast<unsigned>(std::min(count - done, kMost)));
    if (put <= 0) {
      throw std::runtime_error("cannot write");
    }
    done += static_cast<std::size_t>(put);
  }
  return count;
}

std::uint64_t GzOutput::Seek(std::int64_t, TSeekOrigin) { throw std::logic_error("the stream cannot seek"); }
std::uint64_t GzOutput::getTotalBytesCount() const { return getPosition(); }
std::uint64_t GzOutput::getPosition() const { return static_cast<std::uint64_t>(::gztell(file_)); }

void GzOutput::close() {
  const gzFile file = file_;
  file_ = nullptr;
  if (file != nullptr && ::gzclose(file) != Z_OK) {
    throw std::runtime_error("cannot write");
  }
}

}  // namespace loopmark::mrpt_bridge::internal
