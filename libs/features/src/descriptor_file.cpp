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

DescriptorFile joined(const search::DescriptorMatrix& points, search::DescriptorMatrix descriptors,
                      const std::string& file) {
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
  out.descriptors = std::move(descriptors);
  return out;
}

}  // namespace

DescriptorFile read_descriptors(const std::filesystem::path& npz) {
  const std::string file = npz.string();
  const std::map<std::string, std::string> members = internal::unzip(storage::read_file(npz), file);
  const auto array = [&](const std::string& name) -> std::optional<search::DescriptorMatrix> {
    const auto found = members.find(name + ".npy");
    return found == members.end() ? std::nullopt : std::optional(internal::parse_npy(found->second, file, name));
  };
  std::optional<search::DescriptorMatrix> descriptors;
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
    std::optional<search::DescriptorMatrix> candidate = array(name);
    const bool fits = candidate && candidate->cols() == 3 && candidate->rows() == descriptors->rows();
    points = fits || !points ? (candidate ? candidate : points) : points;
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
  search::DescriptorMatrix descriptors =
      internal::parse_npy(storage::read_file(descriptors_npy), descriptors_npy.string(), "");
  return joined(internal::parse_npy(storage::read_file(points_npy), points_npy.string(), ""), std::move(descriptors),
                descriptors_npy.string());
}

}  // namespace loopmark::features
