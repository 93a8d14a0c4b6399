// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/fft2d.hpp"

#include <cmath>
#include <numbers>

#include "loopmark/core/error.hpp"

namespace loopmark::bev {
namespace {

constexpr std::size_t kWidth = 8;  // columns in a bundle

/// One float of each column of a bundle. A vector type: compilers do not find the parallel lanes by themselves here.
using Lanes = float __attribute__((vector_size(kWidth * sizeof(float)), aligned(alignof(float)), may_alias));

/// One stage's input or output: real and imaginary parts of a bundle.
struct Bundle {
  Lanes* re;
  Lanes* im;
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
      const std::size_t a = q + s * p;
      const std::size_t b = a + s * m;
      const std::size_t c = b + s * m;
      const std::size_t d = c + s * m;
      const std::size_t o = q + s * 4 * p;
      const Lanes apc_re = x.re[a] + x.re[c];
      const Lanes apc_im = x.im[a] + x.im[c];
      const Lanes amc_re = x.re[a] - x.re[c];
      const Lanes amc_im = x.im[a] - x.im[c];
      const Lanes bpd_re = x.re[b] + x.re[d];
      const Lanes bpd_im = x.im[b] + x.im[d];
      // -i * (b - d)
      const Lanes bmd_re = x.im[b] - x.im[d];
      const Lanes bmd_im = x.re[d] - x.re[b];
      y.re[o] = apc_re + bpd_re;
      y.im[o] = apc_im + bpd_im;
      const Lanes r1 = amc_re + bmd_re;
      const Lanes i1 = amc_im + bmd_im;
      y.re[o + s] = r1 * c1 - i1 * s1;
      y.im[o + s] = r1 * s1 + i1 * c1;
      const Lanes r2 = apc_re - bpd_re;
      const Lanes i2 = apc_im - bpd_im;
      y.re[o + 2 * s] = r2 * c2 - i2 * s2;
      y.im[o + 2 * s] = r2 * s2 + i2 * c2;
      const Lanes r3 = amc_re - bmd_re;
      const Lanes i3 = amc_im - bmd_im;
      y.re[o + 3 * s] = r3 * c3 - i3 * s3;
      y.im[o + 3 * s] = r3 * s3 + i3 * c3;
    }
  }
}

/// The last radix-2 stage (n = 2), for sides that are no power of four.
__attribute__((target_clones("avx2", "default"))) void stage2(Bundle x, Bundle y, std::size_t s) {
  for (std::size_t q = 0; q < s; ++q) {
    const std::size_t b = q + s;
    y.re[q] = x.re[q] + x.re[b];
    y.im[q] = x.im[q] + x.im[b];
    y.re[b] = x.re[q] - x.re[b];
    y.im[b] = x.im[q] - x.im[b];
  }
}

void load(const std::vector<float>& from, std::size_t column, std::size_t side, Lanes* to) {
  for (std::size_t row = 0; row < side; ++row) {
    to[row] = *reinterpret_cast<const Lanes*>(&from[row * side + column]);
  }
}

/// Transposes 8 x 8 floats: lanes j of in[0 .. 7] become the row out + j * stride.
__attribute__((target_clones("avx2", "default"))) void transpose(const Lanes* in, float* out, std::size_t stride) {
  Lanes pairs[kWidth];  // NOLINT(modernize-avoid-c-arrays): a template drops the attributes of the type
  Lanes fours[kWidth];  // NOLINT(modernize-avoid-c-arrays)
  for (std::size_t i = 0; i < kWidth; i += 2) {
    pairs[i] = __builtin_shufflevector(in[i], in[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[i + 1] = __builtin_shufflevector(in[i], in[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (std::size_t i = 0; i < kWidth; i += 4) {
    fours[i] = __builtin_shufflevector(pairs[i], pairs[i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
    fours[i + 1] = __builtin_shufflevector(pairs[i], pairs[i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    fours[i + 2] = __builtin_shufflevector(pairs[i + 1], pairs[i + 3], 0, 1, 8, 9, 4, 5, 12, 13);
    fours[i + 3] = __builtin_shufflevector(pairs[i + 1], pairs[i + 3], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  for (std::size_t j = 0; j < kWidth / 2; ++j) {
    *reinterpret_cast<Lanes*>(out + j * stride) =
        __builtin_shufflevector(fours[j], fours[j + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    *reinterpret_cast<Lanes*>(out + (j + 4) * stride) =
        __builtin_shufflevector(fours[j], fours[j + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// Writes the bundle's columns as rows of the transposed grid.
void store_transposed(const Lanes* from, std::size_t column, std::size_t side, std::vector<float>& to) {
  for (std::size_t i = 0; i < side; i += kWidth) {
    transpose(from + i, to.data() + column * side + i, side);
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
  // Kept by each thread: allocating and clearing them took a tenth of the time.
  thread_local std::vector<float> work;
  thread_local std::vector<float> out_re;
  thread_local std::vector<float> out_im;
  work.resize(4 * kWidth * side_);
  out_re.resize(re.size());
  out_im.resize(im.size());
  auto* const lanes = reinterpret_cast<Lanes*>(work.data());
  for (int axis = 0; axis < 2; ++axis) {
    for (std::size_t column = 0; column < side_; column += kWidth) {
      Bundle x{lanes, lanes + side_};
      Bundle y{lanes + 2 * side_, lanes + 3 * side_};
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

}  // namespace loopmark::bev
