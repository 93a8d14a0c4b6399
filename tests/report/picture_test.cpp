// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cstring>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::report {
namespace {

/// Reads PNG bytes by libpng's own reader.
Image decoded(const std::string& bytes) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0) << header.message;
  header.format = PNG_FORMAT_RGB;
  Image image(header.width, header.height);
  EXPECT_NE(png_image_finish_read(&header, nullptr, image.pixels.data(), 0, nullptr), 0) << header.message;
  return image;
}

Image patterned(std::size_t width, std::size_t height) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {static_cast<std::uint8_t>(7 * i), static_cast<std::uint8_t>(i / 3),
                       static_cast<std::uint8_t>(255 - i)};
  }
  return image;
}

TEST(Png, ReadsBackAsTheSamePixels) {
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{1, 1}, {17, 5}, {64, 300}}) {
    const Image image = patterned(width, height);
    const Image back = decoded(png_bytes(image));
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.pixels, image.pixels);
  }
}

TEST(Png, WritingWhereThereIsNoFolderNamesTheFile) {
  EXPECT_THROW(write_png("/nowhere/at/all.png", Image(2, 2)), InputError);
  const std::string path = testing::TempDir() + "loopmark_picture_test.png";
  write_png(path, patterned(3, 3));
  EXPECT_EQ(decoded(storage::read_file(path)).pixels, patterned(3, 3).pixels);
}

TEST(Clouds, PointsStandWhereTheyAre) {
  const CloudLayer layer{{{1.5F, 2.5F, 0.5F}}, Pose::Identity(), Colour{255, 0, 0}};
  const Window window{0.0, 10.0, 0.0, 5.0};
  const Image above = draw_clouds({layer}, View::kAbove, window, 10);
  ASSERT_EQ(above.height, 5U);
  EXPECT_NE(above.at(1, 2), kWhite);
  const Image side = draw_clouds({layer}, View::kSide, window, 10);
  EXPECT_NE(side.at(1, 4), kWhite);
  for (const Image* image : {&above, &side}) {
    EXPECT_EQ(std::count(image->pixels.begin(), image->pixels.end(), kWhite), 49);
  }
}

TEST(Clouds, LayersMoveByTheirPose) {
  CloudLayer layer{{{0.5F, 0.5F, 0.0F}}, Pose::Identity(), kInk};
  layer.T_picture_layer.translation() = Eigen::Vector3d(3.0, 1.0, 0.0);
  const Image image = draw_clouds({layer}, View::kAbove, {0.0, 5.0, 0.0, 5.0}, 5);
  EXPECT_NE(image.at(3, 3), kWhite);
}

TEST(Clouds, WindowLeavesOutStrayPointsAndBadOnes) {
  CloudLayer layer{{}, Pose::Identity(), kInk};
  for (int i = 0; i < 1000; ++i) {
    layer.points.emplace_back(static_cast<float>(i % 100), static_cast<float>(i % 50), 0.0F);
  }
  layer.points.emplace_back(1e6F, -1e6F, 0.0F);
  layer.points.emplace_back(std::nanf(""), 0.0F, 0.0F);
  const Window window = fitting_window({layer}, View::kAbove);
  EXPECT_NEAR(window.left, -4.0, 1.5);
  EXPECT_NEAR(window.right, 103.0, 1.5);
  EXPECT_NEAR(window.top, 53.0, 1.5);
  EXPECT_LT(fitting_window({}, View::kSide).left, fitting_window({}, View::kSide).right);
}

TEST(Clouds, PictureOfMotionsHasAPanelForEach) {
  const std::vector<Eigen::Vector3f> corner = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 10, 3}, {5, 5, 1}, {2, 8, 2}};
  const Pose wrong = pose_from_yaw(1.0, {3.0, 1.0, 0.0});
  const Image two = motions_picture(corner, corner, {{"a", wrong}, {"true", Pose::Identity()}}, 640);
  const Image three = motions_picture(corner, corner, {{"a", wrong}, {"b", wrong}, {"true", Pose::Identity()}}, 960);
  EXPECT_EQ(two.width, 640U);
  EXPECT_EQ(three.width, 960U);
  EXPECT_EQ(three.height, motions_picture(corner, corner, {{"a", wrong}, {"a", wrong}, {"true", {}}}, 960).height);
  // The panels of one motion look alike, those of another do not.
  const auto panel = [](const Image& image, std::size_t from) {
    std::vector<Colour> pixels;
    for (std::size_t row = 60; row < image.height; ++row) {
      for (std::size_t column = from; column < from + 300; ++column) {
        pixels.push_back(image.at(column, row));
      }
    }
    return pixels;
  };
  const auto same = [](const std::vector<Colour>& a, const std::vector<Colour>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Colour& x, const Colour& y) {
      return x.red == y.red && x.green == y.green && x.blue == y.blue;
    });
  };
  const std::size_t step = (960 - 16) / 3 + 8;
  EXPECT_FALSE(same(panel(three, 0), panel(three, 2 * step)));
  const Image alike = motions_picture(corner, corner, {{"same", wrong}, {"same", wrong}}, 640);
  EXPECT_TRUE(same(panel(alike, 0), panel(alike, 324)));
  EXPECT_THROW(motions_picture(corner, corner, {}, 640), std::invalid_argument);
}

TEST(Clouds, PictureOfARegistrationShowsBothBeforeAndAfter) {
  std::vector<Eigen::Vector3f> target;
  for (int i = 0; i < 400; ++i) {
    target.emplace_back(0.1F * static_cast<float>(i), static_cast<float>(i % 20), static_cast<float>(i % 3));
  }
  const Pose motion = pose_from_yaw(0.5, {4.0, 2.0, 0.0});
  std::vector<Eigen::Vector3f> source;
  for (const auto& point : target) {
    source.push_back((motion.inverse() * point.cast<double>()).cast<float>());
  }
  const Image image = registration_picture(source, target, motion, 400);
  EXPECT_EQ(image.width, 400U);
  EXPECT_EQ(png_bytes(image), png_bytes(registration_picture(source, target, motion, 400)));
  const auto share = [&](Colour colour, std::size_t from, std::size_t to) {
    std::size_t found = 0;
    for (std::size_t row = 60; row < image.height; ++row) {
      for (std::size_t column = from; column < to; ++column) {
        const Colour& pixel = image.at(column, row);
        found += pixel.red < 250 && (pixel.red > pixel.blue) == (colour.red > colour.blue) ? 1 : 0;
      }
    }
    return found;
  };
  EXPECT_GT(share(palette(0), 0, 196), 20U) << "before: the target is seen beside the source";
  EXPECT_LT(share(palette(0), 204, 400), share(palette(0), 0, 196)) << "after: the source covers the target";
}

}  // namespace
}  // namespace loopmark::report
