// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a polar histogram says independent of yaw: a turn multiplies the k-th harmonic of every ring by the same
/// exp(i k yaw), so the magnitudes stay, and so does the phase of a ring relative to its inner neighbour.
#pragma once

#include <cstddef>

#include "polar_histogram.hpp"

namespace loopmark::shape_context::internal {

constexpr std::size_t kHarmonics = kSectors / 2 + 1;  ///< magnitudes: 0 (the mean) to the highest
constexpr std::size_t kPhases = kSectors / 2 - 1;     ///< harmonics 1 to this one keep relative phases
constexpr std::size_t kMagnitudes = kBands * kRings * kHarmonics;
constexpr std::size_t kSpectrum = kMagnitudes + kBands * (kRings - 1) * kPhases * 2;

/// kSpectrum numbers of unit length (all zero for an empty histogram). With c[b][r][k] the discrete Fourier transform
/// over the sectors of the square roots of the counts: |c|^(1/2) (times 2^(1/4) for k > 0: a real signal has these
/// twice), then the signed square roots of the real and imaginary parts of
/// c[b][r][k] conj(c[b][r-1][k]) / |c[b][r][k] c[b][r-1][k]|^(1/2).
void ring_spectrum(const PolarHistogram& histogram, float* out);

}  // namespace loopmark::shape_context::internal
