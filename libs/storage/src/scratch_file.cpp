// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/scratch_file.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include "loopmark/core/error.hpp"

namespace loopmark::storage {

ScratchFile::ScratchFile(std::filesystem::path path)
    : path_(std::move(path)), stream_(path_, std::ios::binary | std::ios::in | std::ios::out | std::ios::trunc) {
  if (!stream_) {
    throw InputError(path_.string(), "", std::string("cannot write: ") + std::strerror(errno),
                     "check the folder's rights");
  }
}

ScratchFile::~ScratchFile() {
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

Extent ScratchFile::append(const std::string& bytes) {
  const Extent extent{end_, bytes.size()};
  stream_.seekp(static_cast<std::streamoff>(end_));
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream_.flush();
  if (!stream_) {
    throw InputError(path_.string(), "", "cannot write", "check the disk's space");
  }
  end_ += bytes.size();
  return extent;
}

std::string ScratchFile::read(const Extent& extent) {
  std::string bytes(extent.size, '\0');
  stream_.seekg(static_cast<std::streamoff>(extent.offset));
  stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) {
    throw InputError(path_.string(), "", "cannot read what was written", "check the disk");
  }
  return bytes;
}

}  // namespace loopmark::storage
