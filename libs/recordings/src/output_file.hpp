// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace loopmark::recordings::internal {

/// A file that grows under another name ("x.mcap.partial") until it is finished, and vanishes when it is not.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::uint64_t size() const { return size_; }
  void append(std::string_view bytes);
  /// Replaces bytes written before.
  void replace(std::uint64_t offset, std::string_view bytes);
  /// Throws InputError when not all could be written.
  void finish();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_, partial_;
  std::ofstream out_;
  std::uint64_t size_ = 0;
  bool finished_ = false;
};

/// Appends little-endian numbers and strings with their length before them.
template <class T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}
inline void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

}  // namespace loopmark::recordings::internal
