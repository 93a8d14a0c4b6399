// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ring_spectrum_kernels.hpp"

#include <cmath>

#include "loopmark/core/dispatch.hpp"

namespace loopmark::shape_context::internal {

LOOPMARK_DISPATCH
void transform(const float* signal, std::size_t count, const float* waves, float* __restrict parts) {
  using Vector = float __attribute__((vector_size(32), aligned(4)));
  static_assert(kTerms == 5 * 8);
  Vector a{}, b{}, c{}, d{}, e{};
  for (std::size_t s = 0; s < count; ++s) {
    const auto* wave = reinterpret_cast<const Vector*>(waves + s * kTerms);
    const float x = signal[s];
    a += x * wave[0];
    b += x * wave[1];
    c += x * wave[2];
    d += x * wave[3];
    e += x * wave[4];
  }
  auto* out = reinterpret_cast<Vector*>(parts);
  out[0] = a;
  out[1] = b;
  out[2] = c;
  out[3] = d;
  out[4] = e;
}

LOOPMARK_DISPATCH
void square_roots(const float* x, std::size_t count, float* __restrict roots) {
  for (std::size_t i = 0; i < count; ++i) {
    roots[i] = std::sqrt(x[i]);
  }
}

LOOPMARK_DISPATCH
void magnitudes(const float* parts, float* __restrict magnitude) {
  for (std::size_t k = 0; k < kPart; ++k) {
    magnitude[k] = std::sqrt(parts[k] * parts[k] + parts[kPart + k] * parts[kPart + k]);
  }
}

LOOPMARK_DISPATCH
void relative_phases(const float* parts, const float* magnitude, const float* other_parts, const float* other_magnitude,
                     float* __restrict real, float* __restrict imaginary) {
  constexpr float kTiny = 1e-6F;
  for (std::size_t k = 0; k < kPart; ++k) {
    const float a = parts[k];
    const float b = parts[kPart + k];
    const float c = other_parts[k];
    const float d = other_parts[kPart + k];
    const float scale = 1.0F / std::sqrt(magnitude[k] * other_magnitude[k] + kTiny);
    const float re = (a * c + b * d) * scale;
    const float im = (b * c - a * d) * scale;
    const float root_re = std::sqrt(re < 0.0F ? -re : re);
    const float root_im = std::sqrt(im < 0.0F ? -im : im);
    real[k] = re < 0.0F ? -root_re : root_re;
    imaginary[k] = im < 0.0F ? -root_im : root_im;
  }
}

}  // namespace loopmark::shape_context::internal
