// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/descriptor_export.hpp"

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::features {
namespace {

constexpr std::size_t kLargest = std::size_t{1} << 29U;  // bytes; read_descriptors takes no more

std::string little_endian(std::uint64_t value, int bytes) {
  std::string out;
  for (int k = 0; k < bytes; ++k) {
    out += static_cast<char>(value >> (8 * k) & 0xFFU);
  }
  return out;
}

/// A two-dimensional array as numpy.save writes it, format version 1.
std::string npy(const std::string& type, std::size_t rows, std::size_t columns, std::string_view numbers) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ", " +
                       std::to_string(columns) + "), }";
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kBefore = 10;  // magic, version and length
  header += std::string(kAlignment - (header.size() + kBefore + 1) % kAlignment, ' ') + "\n";
  return std::string("\x93NUMPY\x01\x00", 8) + little_endian(header.size(), 2) + header + std::string(numbers);
}

template <class Matrix>
std::string_view bytes_of(const Matrix& matrix) {
  return {reinterpret_cast<const char*>(matrix.data()),
          static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar)};
}

std::string npy(const search::DescriptorMatrix& m) {
  return npy("<f4", static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.cols()), bytes_of(m));
}

std::string npy(const search::QuantizedDescriptors& m) {
  return npy("|i1", static_cast<std::size_t>(m.rows()), static_cast<std::size_t>(m.cols()), bytes_of(m));
}

/// What the local header and the directory of a ZIP archive both say of a stored member: version to extract, flags,
/// method, time and date (1980-01-01), checksum, sizes, lengths of the name and of extra fields.
std::string described(const std::string& name, const std::string& content) {
  constexpr std::uint64_t kVersion = 20;
  constexpr std::uint64_t kFirstDate = 0x21;
  return little_endian(kVersion, 2) + little_endian(0, 6) + little_endian(kFirstDate, 2) +
         little_endian(storage::crc32(content), 4) + little_endian(content.size(), 4) +
         little_endian(content.size(), 4) + little_endian(name.size(), 2) + little_endian(0, 2);
}

std::string zip(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string bytes;
  std::string directory;
  for (const auto& [name, content] : members) {
    const std::string description = described(name, content);
    directory += std::string("PK\1\2", 4) + little_endian(20, 2) + description + little_endian(0, 10) +
                 little_endian(bytes.size(), 4) + name;
    bytes += std::string("PK\3\4", 4) + description + name + content;
  }
  const std::string end = std::string("PK\5\6", 4) + little_endian(0, 4) + little_endian(members.size(), 2) +
                          little_endian(members.size(), 2) + little_endian(directory.size(), 4) +
                          little_endian(bytes.size(), 4) + little_endian(0, 2);
  return bytes + directory + end;
}

}  // namespace

void export_descriptors(const std::filesystem::path& npz, const std::vector<Eigen::Vector3f>& points,
                        const search::DescriptorRows& descriptors) {
  const auto rows = std::visit([](const auto& m) { return static_cast<std::size_t>(m.rows()); }, descriptors);
  if (rows != points.size()) {
    throw std::invalid_argument("export_descriptors: one row for each point is needed");
  }
  search::DescriptorMatrix xyz(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    xyz.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  const std::string bytes =
      zip({{"xyz.npy", npy(xyz)}, {"features.npy", std::visit([](const auto& m) { return npy(m); }, descriptors)}});
  if (bytes.size() > kLargest) {
    throw InputError(npz.string(), "", "would be larger than 512 MiB", "describe fewer points");
  }
  storage::write_file_atomically(npz, bytes);
}

}  // namespace loopmark::features
