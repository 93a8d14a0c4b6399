// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Plain memory to bytes and back, for states that this very program reads again. Reading throws InputError where the
/// bytes end early.
#pragma once

#include <Eigen/Core>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "loopmark/core/error.hpp"

namespace loopmark::storage {

/// `content` behind its checksum.
std::string sealed(const std::string& content);

/// The content of sealed bytes. Throws InputError naming `what` where they are damaged.
std::string unsealed(const std::string& bytes, const std::string& what);

class ByteWriter {
 public:
  template <class T>
  void raw(const T* values, std::size_t count) {
    bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  template <class T>
  void value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&value, 1);
  }
  template <class T>
  void vector(const std::vector<T>& values) {
    value(values.size());
    raw(values.data(), values.size());
  }
  void points(const std::vector<Eigen::Vector3f>& points) {
    value(points.size());
    raw(points.data(), points.size());
  }
  void text(const std::string& text) {
    value(text.size());
    raw(text.data(), text.size());
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  void raw(T* values, std::size_t count) {
    if (count > (bytes_.size() - at_) / sizeof(T)) {
      throw InputError("the saved state is cut off");
    }
    std::memcpy(static_cast<void*>(values), bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }
  template <class T>
  T value() {
    T result;
    raw(&result, 1);
    return result;
  }
  template <class T>
  std::vector<T> vector() {
    const auto count = value<std::size_t>();
    if (count > (bytes_.size() - at_) / sizeof(T)) {
      throw InputError("the saved state is cut off");
    }
    std::vector<T> result(count);
    raw(result.data(), count);
    return result;
  }
  std::vector<Eigen::Vector3f> points() {
    std::vector<Eigen::Vector3f> result;
    for (auto left = value<std::size_t>(); left > 0; --left) {
      raw(result.emplace_back().data(), 3);
    }
    return result;
  }
  std::string text() {
    const std::vector<char> letters = vector<char>();
    return {letters.begin(), letters.end()};
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace loopmark::storage
