// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The bytes of ROS's messages: ROS 1's packed fields and the CDR of ROS 2 (OMG DDS-RTPS 10, XCDR version 1), both
/// little-endian. A message's fields are named once, in a function template `fields(wire, message)`, which a WireReader
/// runs to decode and a WireWriter to encode.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "loopmark/core/error.hpp"
#include "loopmark/recordings/recording.hpp"

namespace loopmark::messages {

using recordings::Encoding;

template <class T>
inline constexpr bool kIsNumber = std::is_arithmetic_v<T>;

/// Takes fields off the front of a message. Throws InputError where they do not fit into its bytes, and for encodings
/// that are not read: big-endian CDR, parameter lists, XCDR version 2.
class WireReader {
 public:
  static constexpr bool kWrites = false;
  WireReader(Encoding encoding, std::string_view bytes);
  bool ros1() const { return encoding_ == Encoding::kRos1; }

  template <class T>
  void operator()(T& value) {
    if constexpr (kIsNumber<T>) {
      align(sizeof(T));
      std::memcpy(&value, take(sizeof(T)), sizeof(T));
    } else {
      fields(*this, value);
    }
  }
  void operator()(bool& value);
  void operator()(std::string& text);
  /// uint8[]: a view into the message.
  void bytes(std::string_view& value);
  /// uint8[N].
  void bytes(std::string_view& value, std::size_t count);

  template <class T, std::size_t N>
  void operator()(std::array<T, N>& values) {
    for (T& value : values) {
      (*this)(value);
    }
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    std::uint32_t count = 0;
    (*this)(count);
    if (count > left()) {  // every element has at least one byte
      throw_too_short();
    }
    values.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      (*this)(values.emplace_back());
    }
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  const char* take(std::size_t count);
  void align(std::size_t size);
  [[noreturn]] void throw_too_short() const;

  Encoding encoding_;
  std::string_view bytes_;
  std::size_t origin_ = 0;  ///< where alignment counts from
  std::size_t at_ = 0;
};

/// Appends fields to a message.
class WireWriter {
 public:
  static constexpr bool kWrites = true;
  explicit WireWriter(Encoding encoding);
  bool ros1() const { return encoding_ == Encoding::kRos1; }

  template <class T>
  void operator()(const T& value) {
    if constexpr (kIsNumber<T>) {
      align(sizeof(T));
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    } else {
      fields(*this, const_cast<T&>(value));  // fields() only reads from it here
    }
  }
  void operator()(const std::string& text);
  void bytes(const std::string_view& value);
  void bytes(const std::string_view& value, std::size_t count);

  template <class T, std::size_t N>
  void operator()(const std::array<T, N>& values) {
    for (const T& value : values) {
      (*this)(value);
    }
  }
  template <class T>
  void operator()(const std::vector<T>& values) {
    (*this)(static_cast<std::uint32_t>(values.size()));
    for (const T& value : values) {
      (*this)(value);
    }
  }
  std::string finish() { return std::move(bytes_); }

 private:
  void align(std::size_t size);

  Encoding encoding_;
  std::string bytes_;
};

template <class Message>
Message decode(Encoding encoding, std::string_view bytes) {
  WireReader reader(encoding, bytes);
  Message message;
  reader(message);
  return message;
}

template <class Message>
std::string encode(Encoding encoding, const Message& message) {
  WireWriter writer(encoding);
  writer(message);
  return writer.finish();
}

}  // namespace loopmark::messages
