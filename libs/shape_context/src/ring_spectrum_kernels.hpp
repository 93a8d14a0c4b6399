// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace loopmark::shape_context::internal {

constexpr std::size_t kPart = 20;          ///< room for the harmonics of one ring, real or imaginary parts
constexpr std::size_t kTerms = 2 * kPart;  ///< both

/// Sums over s of signal[s] * waves[s][*]: the real parts of the harmonics, then the imaginary parts.
void transform(const float* signal, std::size_t count, const float* waves, float* parts);

/// The square roots of `count` numbers that are not negative.
void square_roots(const float* x, std::size_t count, float* roots);

/// magnitude[k] = (re[k]^2 + im[k]^2)^(1/2) of one ring.
void magnitudes(const float* parts, float* magnitude);

/// The product of one ring's harmonics with the conjugates of those of another, divided by the square root of its
/// magnitude, then the signed square roots of real and imaginary parts.
void relative_phases(const float* parts, const float* magnitude, const float* other_parts, const float* other_magnitude,
                     float* real, float* imaginary);

}  // namespace loopmark::shape_context::internal
