// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/places/place_descriptor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "loopmark/storage/files.hpp"
#include "spectrum.hpp"

namespace loopmark::places {
namespace {

// Found on real pairs (recall of the first answers): neither the strong low frequencies nor the mean over directions
// should drown what tells places apart.
constexpr float kMagnitudePower = 0.7F;
constexpr float kHarmonicWeight = 2.0F;

constexpr std::uint32_t kOutdated = 0x3153504cU;  // "LPS1": heights of 0.4 to 8 m
constexpr std::uint32_t kMagic = 0x3253504cU;     // "LPS2"

}  // namespace

void check(const PlaceOptions& o) {
  require_option(o.cell_m > 0.0 && o.cell_m <= 10.0, "cell_m", "must be above 0, at most 10");
  require_option(o.radius_m / o.cell_m >= 16.0 && o.radius_m / o.cell_m <= 512.0, "radius_m",
                 "must be 16 to 512 cells");
  require_option(o.min_height_m < o.max_height_m, "min_height_m", "must be below max_height_m");
  require_option(o.radii >= 1 && o.radii <= 256, "radii", "must be 1 to 256");
  require_option(o.angles >= 2 && o.angles <= 512, "angles", "must be 2 to 512");
  require_option(o.harmonics >= 1 && o.harmonics <= o.angles / 2 + 1, "harmonics", "must be 1 to angles / 2 + 1");
}

PlaceDescriptor place_descriptor(const std::vector<Eigen::Vector3f>& levelled_points, const PlaceOptions& options) {
  check(options);
  const Eigen::MatrixXf image = internal::bev_image(levelled_points, options);
  const Eigen::MatrixXf polar = internal::polar_spectrum(image, options).array().pow(kMagnitudePower);
  Eigen::MatrixXf harmonics = internal::direction_harmonics(polar, options);
  harmonics.rightCols(harmonics.cols() - 1) *= kHarmonicWeight;
  for (Eigen::Index r = 0; r < harmonics.rows(); ++r) {
    harmonics.row(r) *= std::sqrt(static_cast<float>(r + 2));
  }
  const float length = harmonics.norm();
  PlaceDescriptor descriptor;
  descriptor.values.assign(harmonics.data(), harmonics.data() + harmonics.size());
  for (float& value : descriptor.values) {
    value = length > 0.0F ? value / length : 0.0F;
  }
  return descriptor;
}

void require_sound(const PlaceDescriptor& descriptor, const PlaceOptions& options) {
  constexpr float kLargest = 1.0F + 1e-5F;  // of a vector of length 1, with rounding
  const bool sound = descriptor.values.size() == options.radii * options.harmonics &&
                     std::all_of(descriptor.values.begin(), descriptor.values.end(),
                                 [](float value) { return std::abs(value) <= kLargest; });
  if (!sound) {
    throw InputError("place descriptor", "", "it has another length, or numbers that are none", "compute it again");
  }
}

double distance(const PlaceDescriptor& a, const PlaceDescriptor& b) {
  if (a.values.size() != b.values.size()) {
    throw std::invalid_argument("place descriptors of different sizes");
  }
  const auto size = static_cast<Eigen::Index>(a.values.size());
  return static_cast<double>((Eigen::Map<const Eigen::VectorXf>(a.values.data(), size) -
                              Eigen::Map<const Eigen::VectorXf>(b.values.data(), size))
                                 .norm());
}

std::string PlaceDescriptor::to_bytes() const {
  const auto count = static_cast<std::uint32_t>(values.size());
  std::string bytes(8 + 4 * values.size(), '\0');
  std::memcpy(bytes.data(), &kMagic, 4);
  std::memcpy(bytes.data() + 4, &count, 4);
  if (count > 0) {
    std::memcpy(bytes.data() + 8, values.data(), 4 * values.size());
  }
  const std::uint32_t checksum = storage::crc32(bytes);
  bytes.append(reinterpret_cast<const char*>(&checksum), 4);
  return bytes;
}

bool PlaceDescriptor::is_outdated(const std::string& bytes) {
  std::uint32_t magic = 0;
  std::memcpy(&magic, bytes.data(), std::min(bytes.size(), sizeof magic));
  return magic == kOutdated;
}

PlaceDescriptor PlaceDescriptor::from_bytes(const std::string& bytes) {
  std::uint32_t head[2] = {0, 0};
  std::uint32_t checksum = 0;
  if (bytes.size() >= 12) {
    std::memcpy(head, bytes.data(), 8);
    std::memcpy(&checksum, bytes.data() + bytes.size() - 4, 4);
  }
  if (bytes.size() < 12 || head[0] != kMagic || bytes.size() != 12 + 4 * static_cast<std::size_t>(head[1]) ||
      checksum != storage::crc32(std::string_view(bytes).substr(0, bytes.size() - 4))) {
    throw InputError("place descriptor", "", "its bytes are damaged", "compute it again");
  }
  PlaceDescriptor descriptor;
  descriptor.values.resize(head[1]);
  if (head[1] > 0) {
    std::memcpy(descriptor.values.data(), bytes.data() + 8, 4 * descriptor.values.size());
  }
  return descriptor;
}

}  // namespace loopmark::places
