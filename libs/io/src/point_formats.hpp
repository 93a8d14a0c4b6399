// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The readers of the single formats behind read_point_file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "loopmark/io/point_files.hpp"

namespace loopmark::io::internal {

/// A file's bytes, read in one go.
class FileBytes {
 public:
  /// Throws DamagedScan when the file cannot be read or is empty.
  explicit FileBytes(const std::filesystem::path& path);
  std::span<const char> bytes() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
};

/// Throws DamagedScan: the file ends before what its header or layout promises.
[[noreturn]] void throw_truncated(const std::string& file, std::size_t bytes_there, std::size_t bytes_needed);

PointFile read_bin(std::span<const char> bytes, std::size_t columns, const std::string& file,
                   const LogOptions& options);
PointFile read_pcd(std::span<const char> bytes, const std::string& file, const LogOptions& options);
PointFile read_ply(std::span<const char> bytes, const std::string& file, const LogOptions& options);

/// Rows of numbers as text (PCD and PLY ascii): `rows` x `columns` float64 values, row-major. Throws DamagedScan
/// with the line; `first_line` is the number of the first row's line.
std::vector<double> read_ascii_table(std::span<const char> bytes, std::size_t rows, std::size_t columns,
                                     const std::string& file, std::size_t first_line);

/// LZF decompression (as PCD binary_compressed uses it); false when the data does not fill `out` exactly.
bool lzf_decompress(std::span<const char> in, std::span<char> out);

}  // namespace loopmark::io::internal
