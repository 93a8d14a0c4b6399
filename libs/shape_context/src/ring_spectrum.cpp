// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ring_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ring_spectrum_kernels.hpp"

namespace loopmark::shape_context::internal {
namespace {

static_assert(kHarmonics <= kPart);

using Waves = std::array<float, kSectors * kTerms>;

/// cos and -sin of k * s / kSectors of a full turn, for each sector s.
Waves make_waves() {
  Waves waves{};
  for (std::size_t s = 0; s < kSectors; ++s) {
    for (std::size_t k = 0; k < kHarmonics; ++k) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(k * s % kSectors) / kSectors;
      waves[s * kTerms + k] = static_cast<float>(std::cos(angle));
      waves[s * kTerms + kPart + k] = static_cast<float>(-std::sin(angle));
    }
  }
  return waves;
}

struct RingHarmonics {
  std::array<float, kTerms> parts{};
  std::array<float, kPart> magnitude{};
};

RingHarmonics harmonics_of(const std::array<float, kSectors>& bins) {
  static const Waves waves = make_waves();
  std::array<float, kSectors> roots;
  square_roots(bins.data(), kSectors, roots.data());
  RingHarmonics ring;
  transform(roots.data(), kSectors, waves.data(), ring.parts.data());
  magnitudes(ring.parts.data(), ring.magnitude.data());
  return ring;
}

void normalize(float* x, std::size_t count) {
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    squares += static_cast<double>(x[i]) * static_cast<double>(x[i]);
  }
  const auto scale = squares > 0.0 ? static_cast<float>(1.0 / std::sqrt(squares)) : 0.0F;
  for (std::size_t i = 0; i < count; ++i) {
    x[i] *= scale;
  }
}

}  // namespace

void ring_spectrum(const PolarHistogram& histogram, float* out) {
  constexpr float kTwice = 1.18920712F;  // 2^(1/4)
  float* magnitude = out;
  float* phase = out + kMagnitudes;
  for (const auto& band : histogram) {
    RingHarmonics inner;
    for (std::size_t r = 0; r < kRings; ++r) {
      const RingHarmonics ring = harmonics_of(band[r]);
      std::array<float, kPart> roots;
      square_roots(ring.magnitude.data(), kPart, roots.data());
      magnitude[0] = roots[0];
      for (std::size_t k = 1; k < kHarmonics; ++k) {
        magnitude[k] = kTwice * roots[k];
      }
      magnitude += kHarmonics;
      if (r > 0) {
        std::array<float, kPart> real;
        std::array<float, kPart> imaginary;
        relative_phases(ring.parts.data(), ring.magnitude.data(), inner.parts.data(), inner.magnitude.data(),
                        real.data(), imaginary.data());
        phase = std::copy_n(real.data() + 1, kPhases, phase);
        phase = std::copy_n(imaginary.data() + 1, kPhases, phase);
      }
      inner = ring;
    }
  }
  normalize(out, kSpectrum);
}

}  // namespace loopmark::shape_context::internal
