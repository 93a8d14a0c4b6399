// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/places/place_descriptor.hpp"

#include <gtest/gtest.h>

#include <complex>

#include "../../libs/places/src/spectrum.hpp"
#include "loopmark/core/error.hpp"
#include "towns.hpp"

namespace loopmark::places {
namespace {

using testing::Town;

TEST(PolarSpectrum, IsTheMagnitudeOfTheDiscreteFourierTransform) {
  PlaceOptions options;
  options.radius_m = 16.0;
  options.radii = 5;
  options.angles = 4;
  Rng rng(1);
  const Eigen::MatrixXf image = Eigen::MatrixXf::NullaryExpr(32, 32, [&] { return static_cast<float>(rng.uniform()); });
  const Eigen::MatrixXf polar = internal::polar_spectrum(image, options);
  // Angle 2 of 4 is 0 degrees: frequencies 2, 3.5, 5, 6.5, 8 along x. Whole ones need no interpolation.
  for (const auto& [place, f] : {std::pair{0, 2}, std::pair{2, 5}, std::pair{4, 8}}) {
    std::complex<double> sum = 0.0;
    for (int x = 0; x < 32; ++x) {
      for (int y = 0; y < 32; ++y) {
        sum += static_cast<double>(image(x, y)) * std::polar(1.0, -2.0 * std::numbers::pi * f * x / 32.0);
      }
    }
    EXPECT_NEAR(polar(place, 2), std::abs(sum), 1e-3);
  }
}

TEST(PlaceDescriptor, HasLengthOneAndTheSizeOfItsOptions) {
  const PlaceDescriptor descriptor = place_descriptor(Town(1).seen_from(0, 0, 0));
  EXPECT_EQ(descriptor.values.size(), 512U);
  double sum = 0.0;
  for (const float v : descriptor.values) {
    sum += static_cast<double>(v) * static_cast<double>(v);
  }
  EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST(PlaceDescriptor, IsNearerToTheSamePlaceThanToOthers) {
  const PlaceDescriptor here = place_descriptor(Town(1).seen_from(0, 0, 0));
  double nearest_other = 2.0;
  for (std::uint64_t seed = 2; seed < 22; ++seed) {
    nearest_other = std::min(nearest_other, distance(here, place_descriptor(Town(seed).seen_from(0, 0, 0))));
  }
  for (const double yaw : {0.3, 1.6, std::numbers::pi, -2.0}) {
    EXPECT_LT(distance(here, place_descriptor(Town(1).seen_from(0, 0, yaw))), 0.75 * nearest_other)
        << "turned by " << yaw;
  }
  EXPECT_LT(distance(here, place_descriptor(Town(1).seen_from(3, 4, 2.0))), 0.85 * nearest_other) << "another lane";
  EXPECT_LT(distance(here, place_descriptor(Town(1).seen_from(0, 0, 1.0, 0.6F))), 0.85 * nearest_other)
      << "a sparser sensor";
  Town later(1);
  later.park_cars(99, 25);
  EXPECT_LT(distance(here, place_descriptor(later.seen_from(2, -2, 2.5))), nearest_other) << "other parked cars";
}

TEST(PlaceDescriptor, OfNothingIsZeroAndTellsNothing) {
  const PlaceDescriptor nothing = place_descriptor({});
  EXPECT_EQ(nothing.values.size(), 512U);
  EXPECT_EQ(*std::max_element(nothing.values.begin(), nothing.values.end()), 0.0F);
  const float nan = std::nanf("");
  EXPECT_EQ(place_descriptor({{nan, 0, 1}, {1, 2, nan}, {1, 1, 0.1F}, {500, 0, 2}}).values, nothing.values);
}

TEST(PlaceDescriptor, BytesComeBackAndDamageIsNoticed) {
  const PlaceDescriptor descriptor = place_descriptor(Town(1).seen_from(0, 0, 0));
  std::string bytes = descriptor.to_bytes();
  EXPECT_EQ(PlaceDescriptor::from_bytes(bytes).values, descriptor.values);
  EXPECT_THROW(PlaceDescriptor::from_bytes(bytes.substr(0, bytes.size() - 1)), InputError);
  EXPECT_THROW(PlaceDescriptor::from_bytes(""), InputError);
  bytes[100] = static_cast<char>(bytes[100] ^ 1);
  EXPECT_THROW(PlaceDescriptor::from_bytes(bytes), InputError);
}

TEST(PlaceDescriptor, OfAnotherLengthOrWithoutNumbersIsRefused) {
  PlaceDescriptor descriptor = place_descriptor(Town(1).seen_from(0, 0, 0));
  EXPECT_NO_THROW(require_sound(descriptor, {}));
  descriptor.values[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(require_sound(descriptor, {}), InputError);
  descriptor.values[7] = 2.0F;
  EXPECT_THROW(require_sound(descriptor, {}), InputError);
  descriptor.values.resize(4);
  descriptor.values.assign(4, 0.5F);
  EXPECT_THROW(require_sound(descriptor, {}), InputError);
}

TEST(PlaceDescriptor, DoesNotChangeWithWhatOnlySomeSensorsSee) {
  std::vector<Eigen::Vector3f> points = Town(5).seen_from(0, 0, 0);
  const PlaceDescriptor without = place_descriptor(points);
  Rng rng(8);
  for (int i = 0; i < 3000; ++i) {  // crowns of trees and upper floors, kerbs and grass
    const auto x = static_cast<float>(rng.uniform(-60.0, 60.0));
    const auto y = static_cast<float>(rng.uniform(-60.0, 60.0));
    points.emplace_back(x, y, static_cast<float>(i % 2 == 0 ? rng.uniform(3.1, 9.0) : rng.uniform(0.0, 0.9)));
  }
  EXPECT_EQ(place_descriptor(points).values, without.values);
}

TEST(PlaceDescriptor, OfAnEarlierVersionIsTold) {
  std::string bytes = place_descriptor(Town(5).seen_from(0, 0, 0)).to_bytes();
  EXPECT_FALSE(PlaceDescriptor::is_outdated(bytes));
  EXPECT_FALSE(PlaceDescriptor::is_outdated(""));
  bytes.replace(0, 4, "LPS1");
  EXPECT_TRUE(PlaceDescriptor::is_outdated(bytes));
  EXPECT_THROW(PlaceDescriptor::from_bytes(bytes), InputError);
}

TEST(PlaceDescriptor, OptionsAreChecked) {
  PlaceOptions options;
  options.harmonics = 40;
  EXPECT_THROW(place_descriptor({}, options), InputError);
  options = {};
  options.radius_m = 2.0;
  EXPECT_THROW(place_descriptor({}, options), InputError);
  EXPECT_THROW(distance(PlaceDescriptor{{1.0F}}, PlaceDescriptor{{1.0F, 0.0F}}), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::places
