// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/messages/wire.hpp"

namespace loopmark::messages {
namespace {

constexpr std::size_t kEncapsulation =
    4;  // of CDR: a big-endian uint16 that names the representation, two bytes of options

/// The name of a representation that is not read; nothing for plain little-endian CDR.
std::string refused(std::string_view bytes) {
  const auto high = static_cast<unsigned char>(bytes[0]);
  const auto low = static_cast<unsigned char>(bytes[1]);
  if (high != 0) return "an unknown representation";
  switch (low) {
    case 1:
      return "";
    case 0:
      return "big-endian CDR";
    case 2:
    case 3:
      return "CDR as a parameter list";
    case 6:
    case 7:
    case 8:
    case 9:
    case 10:
    case 11:
      return "XCDR version 2";
    default:
      return "an unknown representation";
  }
}

}  // namespace

WireReader::WireReader(Encoding encoding, std::string_view bytes) : encoding_(encoding), bytes_(bytes) {
  if (encoding == Encoding::kOther) {
    throw InputError("a message that is neither CDR nor ROS 1's");
  }
  if (encoding == Encoding::kCdr) {
    if (bytes.size() < kEncapsulation) {
      throw InputError("a CDR message of " + std::to_string(bytes.size()) + " bytes has not even its head");
    }
    const std::string problem = refused(bytes);
    if (!problem.empty()) {
      throw InputError("the message is " + problem + ", which is not read (record with little-endian CDR)");
    }
    origin_ = at_ = kEncapsulation;
  }
}

void WireReader::throw_too_short() const {
  throw InputError("the message of " + std::to_string(bytes_.size()) + " bytes ends within its fields");
}

const char* WireReader::take(std::size_t count) {
  if (count > left()) {
    throw_too_short();
  }
  const char* taken = bytes_.data() + at_;
  at_ += count;
  return taken;
}

void WireReader::align(std::size_t size) {
  if (encoding_ == Encoding::kCdr) {
    take((size - (at_ - origin_) % size) % size);
  }
}

void WireReader::operator()(bool& value) { value = *take(1) != 0; }

void WireReader::operator()(std::string& text) {
  std::string_view view;
  bytes(view);
  if (encoding_ == Encoding::kCdr && !view.empty() && view.back() == '\0') {
    view.remove_suffix(1);
  }
  text = view;
}

void WireReader::bytes(std::string_view& value) {
  std::uint32_t count = 0;
  (*this)(count);
  bytes(value, count);
}

void WireReader::bytes(std::string_view& value, std::size_t count) { value = {take(count), count}; }

WireWriter::WireWriter(Encoding encoding) : encoding_(encoding) {
  if (encoding == Encoding::kCdr) {
    bytes_.assign({'\0', '\1', '\0', '\0'});
  }
}

void WireWriter::align(std::size_t size) {
  if (encoding_ == Encoding::kCdr) {
    bytes_.append((size - (bytes_.size() - kEncapsulation) % size) % size, '\0');
  }
}

void WireWriter::operator()(const std::string& text) {
  const bool cdr = encoding_ == Encoding::kCdr;
  (*this)(static_cast<std::uint32_t>(text.size() + (cdr ? 1 : 0)));
  bytes_ += text;
  if (cdr) {
    bytes_.push_back('\0');
  }
}

void WireWriter::bytes(const std::string_view& value) {
  (*this)(static_cast<std::uint32_t>(value.size()));
  bytes_ += value;
}

void WireWriter::bytes(const std::string_view& value, std::size_t count) {
  bytes_ += value.substr(0, count);
  bytes_.append(count - std::min(count, value.size()), '\0');
}

}  // namespace loopmark::messages
