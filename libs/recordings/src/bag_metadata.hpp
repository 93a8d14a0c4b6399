// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopmark::recordings::internal {

/// What a ROS 2 bag's metadata.yaml says, or what the folder holds where there is none.
struct BagMetadata {
  std::vector<std::filesystem::path> files;  ///< in their order
  bool compressed_messages = false;          ///< each message is a zstd frame
};

/// Throws InputError when metadata.yaml cannot be understood, or neither it nor files are there.
BagMetadata read_bag_metadata(const std::filesystem::path& folder_or_file);

/// A file compressed with zstd, decompressed into a temporary file (SQLite must be able to jump in it) that goes with
/// this object. Throws InputError.
class UnpackedFile {
 public:
  explicit UnpackedFile(const std::filesystem::path& compressed);
  ~UnpackedFile();
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace loopmark::recordings::internal
