// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/descriptor_file.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "npy.hpp"
#include "zip_archive.hpp"

namespace loopmark::features {
namespace {

constexpr std::array kDescriptorNames = {"feature", "features", "descriptors", "descs"};
constexpr std::array kPointNames = {"xyz", "xyz_down", "keypts", "keypoints", "points"};

std::string listed(const std::map<std::string, std::string>& members) {
  std::string names;
  for (const auto& [name, content] : members) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "nothing" : names;
}

/// An array and whether its numbers are of int8.
struct Array {
  search::DescriptorMatrix numbers;
  bool whole = false;
};

Array parsed(std::string_view bytes, const std::string& file, const std::string& name) {
  return {internal::parse_npy(bytes, file, name), internal::is_int8(bytes)};
}

search::QuantizedDescriptors quantized(const search::DescriptorMatrix& numbers, const std::string& file) {
  if ((numbers.array() < -127.0F).any()) {
    throw InputError(file, "", "quantised descriptors hold -128", "round to whole numbers from -127 to 127");
  }
  return numbers.cast<std::int8_t>();
}

DescriptorFile joined(const search::DescriptorMatrix& points, Array array, const std::string& file) {
  search::DescriptorMatrix& descriptors = array.numbers;
  if (points.cols() != 3) {
    throw InputError(file, "points", "have " + std::to_string(points.cols()) + " columns instead of 3");
  }
  if (points.rows() != descriptors.rows()) {
    throw InputError(
        file, "", std::to_string(descriptors.rows()) + " descriptors for " + std::to_string(points.rows()) + " points",
        "export the points that the descriptors belong to, one a row");
  }
  DescriptorFile out;
  for (Eigen::Index r = 0; r < points.rows(); ++r) {
    out.points.emplace_back(points.row(r).transpose());
  }
  if (array.whole) {
    out.descriptors = quantized(descriptors, file);
  } else {
    out.descriptors = std::move(descriptors);
  }
  return out;
}

}  // namespace

DescriptorFile read_descriptors(const std::filesystem::path& npz) {
  const std::string file = npz.string();
  const std::map<std::string, std::string> members = internal::unzip(storage::read_file(npz), file);
  const auto array = [&](const std::string& name) -> std::optional<Array> {
    const auto found = members.find(name + ".npy");
    return found == members.end() ? std::nullopt : std::optional(parsed(found->second, file, name));
  };
  std::optional<Array> descriptors;
  for (const char* name : kDescriptorNames) {
    descriptors = descriptors ? descriptors : array(name);
  }
  if (!descriptors) {
    throw InputError(file, "", "no array of descriptors (there are: " + listed(members) + ")",
                     "name it \"features\", shape (points, dimension)");
  }
  // FCGF stores the raw cloud as "points" beside the downsampled one: the array with as many rows is meant.
  std::optional<search::DescriptorMatrix> points;
  for (const char* name : kPointNames) {
    const std::optional<Array> candidate = array(name);
    const bool fits =
        candidate && candidate->numbers.cols() == 3 && candidate->numbers.rows() == descriptors->numbers.rows();
    if (candidate && (fits || !points)) {
      points = candidate->numbers;
    }
    if (fits) {
      break;
    }
  }
  if (!points) {
    throw InputError(file, "", "no array of points (there are: " + listed(members) + ")",
                     "name it \"xyz\", shape (points, 3)");
  }
  return joined(*points, std::move(*descriptors), file);
}

DescriptorFile read_descriptors(const std::filesystem::path& descriptors_npy, const std::filesystem::path& points_npy) {
  Array descriptors = parsed(storage::read_file(descriptors_npy), descriptors_npy.string(), "");
  return joined(internal::parse_npy(storage::read_file(points_npy), points_npy.string(), ""), std::move(descriptors),
                descriptors_npy.string());
}

}  // namespace loopmark::features
