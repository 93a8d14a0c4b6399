// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace loopmark::places::internal {
namespace {

constexpr float kHighest = 6.0F;      ///< metres; what is higher counts as this high
constexpr double kLongestWave = 2.0;  ///< the lowest frequency sampled, in waves over the image

/// exp(-2 pi i f n / size) for n in [0, size), f in [first, first + count): size x count.
Eigen::MatrixXcf waves(Eigen::Index size, Eigen::Index first, Eigen::Index count) {
  Eigen::MatrixXcf m(size, count);
  for (Eigen::Index f = 0; f < count; ++f) {
    for (Eigen::Index n = 0; n < size; ++n) {
      const Eigen::Index turns = (first + f) * n % size;
      const double angle = -2.0 * std::numbers::pi * static_cast<double>(turns) / static_cast<double>(size);
      m(n, f) = std::complex<float>(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
    }
  }
  return m;
}

float bilinear(const Eigen::MatrixXf& m, double row, double column) {
  const auto r = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(row)), 0, m.rows() - 2);
  const auto c = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(column)), 0, m.cols() - 2);
  const auto u = static_cast<float>(row - static_cast<double>(r));
  const auto v = static_cast<float>(column - static_cast<double>(c));
  return (1 - u) * ((1 - v) * m(r, c) + v * m(r, c + 1)) + u * ((1 - v) * m(r + 1, c) + v * m(r + 1, c + 1));
}

}  // namespace

Eigen::MatrixXf bev_image(const std::vector<Eigen::Vector3f>& points, const PlaceOptions& o) {
  const auto half = static_cast<Eigen::Index>(std::lround(o.radius_m / o.cell_m));
  Eigen::MatrixXf image = Eigen::MatrixXf::Zero(2 * half, 2 * half);
  const auto scale = static_cast<float>(1.0 / o.cell_m);
  for (const Eigen::Vector3f& p : points) {
    if (!(p.z() > o.min_height_m && p.z() < o.max_height_m && p.head<2>().norm() < o.radius_m)) {
      continue;
    }
    const auto row = std::min(static_cast<Eigen::Index>(std::floor(p.x() * scale)) + half, 2 * half - 1);
    const auto column = std::min(static_cast<Eigen::Index>(std::floor(p.y() * scale)) + half, 2 * half - 1);
    float& cell = image(row, column);
    cell = std::max(cell, std::min(p.z(), kHighest));
  }
  for (Eigen::Index c = 0; c < image.cols(); ++c) {
    for (Eigen::Index r = 0; r < image.rows(); ++r) {
      const double x = static_cast<double>(r - half) + 0.5;
      const double y = static_cast<double>(c - half) + 0.5;
      const double part = std::min(1.0, std::hypot(x, y) / static_cast<double>(half));
      image(r, c) = std::sqrt(image(r, c)) * static_cast<float>(std::cos(0.5 * std::numbers::pi * part));
    }
  }
  return image;
}

Eigen::MatrixXf polar_spectrum(const Eigen::MatrixXf& image, const PlaceOptions& o) {
  const Eigen::Index size = image.rows();
  const Eigen::Index highest = size / 4;  // waves of four cells
  // Rows: frequencies 0..highest along x; columns: -highest..highest along y. The rest is its mirror image.
  const Eigen::MatrixXcf along_x = waves(size, 0, highest + 2).transpose() * image;
  const Eigen::MatrixXcf both = along_x * waves(size, size - highest - 1, 2 * highest + 3);
  const Eigen::MatrixXf magnitude = both.cwiseAbs();
  const auto radii = static_cast<Eigen::Index>(o.radii);
  const auto angles = static_cast<Eigen::Index>(o.angles);
  Eigen::MatrixXf polar(radii, angles);
  for (Eigen::Index a = 0; a < angles; ++a) {
    // From -90 to 90 degrees, where the frequency along x is not negative.
    const double angle = std::numbers::pi * (static_cast<double>(a) / static_cast<double>(angles) - 0.5);
    for (Eigen::Index r = 0; r < radii; ++r) {
      const double f = kLongestWave + (static_cast<double>(highest) - kLongestWave) * static_cast<double>(r) /
                                          static_cast<double>(std::max<Eigen::Index>(radii - 1, 1));
      polar(r, a) = bilinear(magnitude, f * std::cos(angle), f * std::sin(angle) + static_cast<double>(highest + 1));
    }
  }
  return polar;
}

Eigen::MatrixXf direction_harmonics(const Eigen::MatrixXf& polar, const PlaceOptions& o) {
  const Eigen::MatrixXcf harmonics = polar * waves(polar.cols(), 0, static_cast<Eigen::Index>(o.harmonics));
  return harmonics.cwiseAbs();
}

}  // namespace loopmark::places::internal
