// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/fft2d.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::bev {
namespace {

ComplexGrid random_grid(std::size_t side) {
  ComplexGrid grid(side);
  Rng rng(side);
  for (std::size_t i = 0; i < side * side; ++i) {
    grid.re[i] = static_cast<float>(rng.normal());
    grid.im[i] = static_cast<float>(rng.normal());
  }
  return grid;
}

std::complex<double> slow_term(const ComplexGrid& grid, std::size_t side, std::size_t ky, std::size_t kx) {
  std::complex<double> sum = 0.0;
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const double angle = -2.0 * std::numbers::pi * static_cast<double>(ky * y + kx * x) / static_cast<double>(side);
      sum += std::complex<double>(grid.re[y * side + x], grid.im[y * side + x]) * std::polar(1.0, angle);
    }
  }
  return sum;
}

class Fft2dSides : public testing::TestWithParam<std::size_t> {};

TEST_P(Fft2dSides, AgreesWithTheDefinition) {
  const std::size_t side = GetParam();
  const ComplexGrid input = random_grid(side);
  ComplexGrid output = input;
  Fft2d(side).forward(output);
  for (const auto& [ky, kx] : {std::pair<std::size_t, std::size_t>{0, 0}, {1, 3}, {5, side - 1}, {side / 2, 2}}) {
    const std::complex<double> expected = slow_term(input, side, ky, kx);
    EXPECT_NEAR(output.re[ky * side + kx], expected.real(), 2e-3 * static_cast<double>(side) / 8);
    EXPECT_NEAR(output.im[ky * side + kx], expected.imag(), 2e-3 * static_cast<double>(side) / 8);
  }
}

TEST_P(Fft2dSides, InverseUndoesForward) {
  const std::size_t side = GetParam();
  const ComplexGrid input = random_grid(side);
  ComplexGrid output = input;
  const Fft2d fft(side);
  fft.forward(output);
  fft.inverse(output);
  const auto scale = static_cast<float>(side * side);
  for (std::size_t i = 0; i < side * side; ++i) {
    ASSERT_NEAR(output.re[i] / scale, input.re[i], 1e-5);
    ASSERT_NEAR(output.im[i] / scale, input.im[i], 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(PowersOfTwo, Fft2dSides, testing::Values(8, 16, 32, 128, 256));

TEST(Fft2d, RefusesOtherSides) { EXPECT_THROW(Fft2d(12), InputError); }

}  // namespace
}  // namespace loopmark::bev
