// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Bytes of a file at any place, every length held against what is there.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace loopmark::recordings::internal {

class ByteSource {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit ByteSource(const std::filesystem::path& file);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return path_; }

  /// Up to `count` bytes at `offset` into `out`; returns how many there were. Thread-safe. Throws InputError when
  /// the disk fails.
  std::size_t read(std::uint64_t offset, char* out, std::size_t count) const;

  /// Exactly `count` bytes. Throws InputError where the file ends before, or `count` is above kMostBytes.
  std::string exactly(std::uint64_t offset, std::uint64_t count) const;

 private:
  std::filesystem::path path_;
  std::uint64_t size_ = 0;
  int handle_ = -1;
};

/// Walks over a ByteSource with a window, so that small records cost no call each and large ones can be passed over.
class Window {
 public:
  explicit Window(const ByteSource& source) : source_(source) {}

  /// The `count` bytes at `offset`; fewer where the file ends. Valid until the next call.
  std::string_view at(std::uint64_t offset, std::size_t count);
  std::uint64_t size() const { return source_.size(); }

 private:
  const ByteSource& source_;
  std::vector<char> bytes_;
  std::uint64_t begin_ = 0;
  std::size_t filled_ = 0;
};

/// A little-endian number at the front of `bytes`, which must hold it.
template <class T>
T number_at(std::string_view bytes, std::size_t offset = 0) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Takes numbers and strings off the front; `ok` turns false, for good, where they do not fit.
struct Taker {
  std::string_view rest;
  bool ok = true;

  template <class T>
  T number() {
    if (rest.size() < sizeof(T)) {
      ok = false;
      return T{};
    }
    const T value = number_at<T>(rest);
    rest.remove_prefix(sizeof(T));
    return value;
  }
  std::string_view bytes(std::uint64_t count);
  /// With its length as uint32 before it.
  std::string_view text() { return bytes(number<std::uint32_t>()); }
};

/// The first bytes of a file; fewer, or none, where there are not so many.
std::string first_bytes(const std::filesystem::path& file, std::size_t count);

}  // namespace loopmark::recordings::internal
