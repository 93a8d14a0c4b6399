// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Two-dimensional complex Fourier transform of square grids whose side is a power of two.
#pragma once

#include <cstddef>
#include <vector>

namespace loopmark::bev {

/// Real and imaginary parts of a square grid, row by row.
struct ComplexGrid {
  explicit ComplexGrid(std::size_t side) : re(side * side), im(side * side) {}

  std::vector<float> re;
  std::vector<float> im;
};

/// Stockham's autosort algorithm, radix 4 and 2, over bundles of eight columns at a time: every butterfly works on
/// eight contiguous floats. The same bytes on
/// every instruction set: no operation is contracted or reordered.
class Fft2d {
 public:
  /// `side`: a power of two, at least 8. Throws InputError else.
  explicit Fft2d(std::size_t side);

  std::size_t side() const { return side_; }
  /// F[k] = sum_x f[x] exp(-2 pi i k x / side) over both axes, in place.
  void forward(ComplexGrid& grid) const;
  /// The inverse without the factor 1 / side^2, in place.
  void inverse(ComplexGrid& grid) const;

 private:
  void transform(std::vector<float>& re, std::vector<float>& im) const;

  std::size_t side_;
  std::vector<float> cosines_;  ///< cos(2 pi k / side)
  std::vector<float> sines_;    ///< -sin(2 pi k / side)
};

}  // namespace loopmark::bev
