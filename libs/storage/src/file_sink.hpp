// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A new file as the end of a stream, with the errors that std::ofstream swallows.
#pragma once

#include <array>
#include <filesystem>
#include <streambuf>

namespace loopmark::storage::internal {

class FileSink : public std::streambuf {
 public:
  /// A file that is there, or a link, is an error.
  explicit FileSink(const std::filesystem::path& path);
  ~FileSink() override;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  /// Writes what is left and waits until the disk has it. False, with error(), where anything went wrong.
  bool finish();
  int error() const { return error_; }  ///< errno of the first failure; 0: none

 protected:
  int_type overflow(int_type letter) override;
  std::streamsize xsputn(const char* text, std::streamsize count) override;
  int sync() override { return flush() ? 0 : -1; }

 private:
  bool flush();
  bool put(const char* bytes, std::size_t count);

  int file_;
  int error_ = 0;
  std::array<char, 1U << 16U> buffer_;
};

}  // namespace loopmark::storage::internal
