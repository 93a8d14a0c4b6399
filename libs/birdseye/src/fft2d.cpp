// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/birdseye/fft2d.hpp"

#include <cmath>
#include <numbers>

#include "loopmark/core/error.hpp"

namespace loopmark::birdseye {
namespace {

constexpr std::size_t kWidth = 8;  // columns in a bundle

/// One stage's input or output: element i holds kWidth floats of each part.
struct Bundle {
  float* re;
  float* im;
};

/// Radix-4 Stockham stage: n points split into quarters, s transforms interleaved.
__attribute__((target_clones("avx2", "default"))) void stage4(Bundle x, Bundle y, std::size_t n, std::size_t s,
                                                              std::size_t side, const float* cosines,
                                                              const float* sines) {
  const std::size_t m = n / 4;
  const std::size_t step = side / n;
  for (std::size_t p = 0; p < m; ++p) {
    const float c1 = cosines[p * step];
    const float s1 = sines[p * step];
    const float c2 = cosines[2 * p * step];
    const float s2 = sines[2 * p * step];
    const float c3 = cosines[3 * p * step];
    const float s3 = sines[3 * p * step];
    for (std::size_t q = 0; q < s; ++q) {
      const std::size_t a = kWidth * (q + s * p);
      const std::size_t b = a + kWidth * s * m;
      const std::size_t c = b + kWidth * s * m;
      const std::size_t d = c + kWidth * s * m;
      const std::size_t o = kWidth * (q + s * 4 * p);
      const std::size_t os = kWidth * s;
      for (std::size_t j = 0; j < kWidth; ++j) {
        const float apc_re = x.re[a + j] + x.re[c + j];
        const float apc_im = x.im[a + j] + x.im[c + j];
        const float amc_re = x.re[a + j] - x.re[c + j];
        const float amc_im = x.im[a + j] - x.im[c + j];
        const float bpd_re = x.re[b + j] + x.re[d + j];
        const float bpd_im = x.im[b + j] + x.im[d + j];
        // -i * (b - d)
        const float bmd_re = x.im[b + j] - x.im[d + j];
        const float bmd_im = x.re[d + j] - x.re[b + j];
        y.re[o + j] = apc_re + bpd_re;
        y.im[o + j] = apc_im + bpd_im;
        const float r1 = amc_re + bmd_re;
        const float i1 = amc_im + bmd_im;
        y.re[o + os + j] = r1 * c1 - i1 * s1;
        y.im[o + os + j] = r1 * s1 + i1 * c1;
        const float r2 = apc_re - bpd_re;
        const float i2 = apc_im - bpd_im;
        y.re[o + 2 * os + j] = r2 * c2 - i2 * s2;
        y.im[o + 2 * os + j] = r2 * s2 + i2 * c2;
        const float r3 = amc_re - bmd_re;
        const float i3 = amc_im - bmd_im;
        y.re[o + 3 * os + j] = r3 * c3 - i3 * s3;
        y.im[o + 3 * os + j] = r3 * s3 + i3 * c3;
      }
    }
  }
}

/// The last radix-2 stage (n = 2), for sides that are no power of four.
__attribute__((target_clones("avx2", "default"))) void stage2(Bundle x, Bundle y, std::size_t s) {
  for (std::size_t q = 0; q < kWidth * s; ++q) {
    const std::size_t b = q + kWidth * s;
    y.re[q] = x.re[q] + x.re[b];
    y.im[q] = x.im[q] + x.im[b];
    y.re[b] = x.re[q] - x.re[b];
    y.im[b] = x.im[q] - x.im[b];
  }
}

void load(const std::vector<float>& from, std::size_t column, std::size_t side, float* to) {
  for (std::size_t row = 0; row < side; ++row) {
    for (std::size_t j = 0; j < kWidth; ++j) {
      to[kWidth * row + j] = from[row * side + column + j];
    }
  }
}

/// Writes the bundle's columns as rows of the transposed grid.
void store_transposed(const float* from, std::size_t column, std::size_t side, std::vector<float>& to) {
  for (std::size_t j = 0; j < kWidth; ++j) {
    float* row = to.data() + (column + j) * side;
    for (std::size_t i = 0; i < side; ++i) {
      row[i] = from[kWidth * i + j];
    }
  }
}

}  // namespace

Fft2d::Fft2d(std::size_t side) : side_(side), cosines_(side), sines_(side) {
  if (side < 8 || (side & (side - 1)) != 0) {
    throw InputError("the side of a transform must be a power of two, at least 8");
  }
  for (std::size_t k = 0; k < side; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(side);
    cosines_[k] = static_cast<float>(std::cos(angle));
    sines_[k] = static_cast<float>(-std::sin(angle));
  }
}

void Fft2d::transform(std::vector<float>& re, std::vector<float>& im) const {
  const std::size_t length = kWidth * side_;
  // Kept by each thread: allocating and clearing them took a tenth of the time.
  thread_local std::vector<float> work;
  thread_local std::vector<float> out_re;
  thread_local std::vector<float> out_im;
  work.resize(4 * length);
  out_re.resize(re.size());
  out_im.resize(im.size());
  for (int axis = 0; axis < 2; ++axis) {
    for (std::size_t column = 0; column < side_; column += kWidth) {
      Bundle x{work.data(), work.data() + length};
      Bundle y{work.data() + 2 * length, work.data() + 3 * length};
      load(re, column, side_, x.re);
      load(im, column, side_, x.im);
      std::size_t n = side_;
      std::size_t s = 1;
      for (; n >= 4; n /= 4, s *= 4) {
        stage4(x, y, n, s, side_, cosines_.data(), sines_.data());
        std::swap(x, y);
      }
      if (n == 2) {
        stage2(x, y, s);
        std::swap(x, y);
      }
      store_transposed(x.re, column, side_, out_re);
      store_transposed(x.im, column, side_, out_im);
    }
    re.swap(out_re);
    im.swap(out_im);
  }
}

void Fft2d::forward(ComplexGrid& grid) const { transform(grid.re, grid.im); }

void Fft2d::inverse(ComplexGrid& grid) const { transform(grid.im, grid.re); }

}  // namespace loopmark::birdseye
