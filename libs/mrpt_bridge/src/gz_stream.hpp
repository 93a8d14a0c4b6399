// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A file, gzipped or not, as MRPT's archives read it, with seeking.
#pragma once

#include <mrpt/io/CStream.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>

namespace loopmark::mrpt_bridge::internal {

/// For reading; plain files too.
class GzStream : public mrpt::io::CStream {
 public:
  /// Throws std::runtime_error when the file cannot be opened.
  explicit GzStream(const std::filesystem::path& path);
  ~GzStream() override;
  GzStream(const GzStream&) = delete;
  GzStream& operator=(const GzStream&) = delete;

  std::size_t Read(void* buffer, std::size_t count) override;
  std::size_t Write(const void* buffer, std::size_t count) override;
  /// Backwards costs reading from the beginning.
  std::uint64_t Seek(std::int64_t offset, TSeekOrigin origin = sFromBeginning) override;
  std::uint64_t getTotalBytesCount() const override;
  std::uint64_t getPosition() const override;
  bool at_end();

 private:
  gzFile file_;
};

/// For writing, with errors that are not lost (MRPT's own stream ignores those of closing).
class GzOutput : public mrpt::io::CStream {
 public:
  /// Throws std::runtime_error when the file cannot be opened.
  explicit GzOutput(const std::filesystem::path& path);
  ~GzOutput() override;
  GzOutput(const GzOutput&) = delete;
  GzOutput& operator=(const GzOutput&) = delete;

  std::size_t Read(void* buffer, std::size_t count) override;
  std::size_t Write(const void* buffer, std::size_t count) override;
  std::uint64_t Seek(std::int64_t offset, TSeekOrigin origin = sFromBeginning) override;
  std::uint64_t getTotalBytesCount() const override;
  std::uint64_t getPosition() const override;
  /// Writes what is buffered. Throws std::runtime_error when the disk is full.
  void close();

 private:
  gzFile file_;
};

}  // namespace loopmark::mrpt_bridge::internal
