// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace loopmark::storage {

/// A place in a scratch file.
struct Extent {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

/// A file that is appended to, read from anywhere, and removed at the end.
class ScratchFile {
 public:
  explicit ScratchFile(std::filesystem::path path);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Throws InputError when the disk is full.
  Extent append(const std::string& bytes);
  std::string read(const Extent& extent);

 private:
  std::filesystem::path path_;
  std::fstream stream_;
  std::uint64_t end_ = 0;
};

}  // namespace loopmark::storage
