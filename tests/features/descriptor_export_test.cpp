// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/descriptor_export.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

#include "loopmark/core/random.hpp"
#include "loopmark/features/descriptor_file.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::features {
namespace {

class DescriptorExport : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / ("descriptor_export_" + std::string(info->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    Rng rng(1);
    for (int i = 0; i < 50; ++i) {
      points_.emplace_back(static_cast<float>(rng.normal()), static_cast<float>(rng.normal()), 1.5F);
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  search::QuantizedDescriptors whole_numbers() const {
    Rng rng(2);
    search::QuantizedDescriptors rows(50, 7);
    for (Eigen::Index k = 0; k < rows.size(); ++k) {
      rows.data()[k] = static_cast<std::int8_t>(static_cast<int>(rng.below(255)) - 127);
    }
    return rows;
  }

  std::filesystem::path folder_;
  std::vector<Eigen::Vector3f> points_;
};

TEST_F(DescriptorExport, IsReadBackAsItWas) {
  const search::QuantizedDescriptors whole = whole_numbers();
  const search::DescriptorMatrix real = whole.cast<float>() / 3.0F;
  export_descriptors(folder_ / "whole.npz", points_, whole);
  export_descriptors(folder_ / "real.npz", points_, real);
  const DescriptorFile first = read_descriptors(folder_ / "whole.npz");
  const DescriptorFile second = read_descriptors(folder_ / "real.npz");
  EXPECT_EQ(first.points, points_);
  EXPECT_EQ(std::get<search::QuantizedDescriptors>(first.descriptors), whole);
  EXPECT_EQ(std::get<search::DescriptorMatrix>(second.descriptors), real);
}

TEST_F(DescriptorExport, WritesTheSameBytesAgain) {
  export_descriptors(folder_ / "a.npz", points_, whole_numbers());
  export_descriptors(folder_ / "b.npz", points_, whole_numbers());
  EXPECT_EQ(storage::read_file(folder_ / "a.npz"), storage::read_file(folder_ / "b.npz"));
}

TEST_F(DescriptorExport, IsWhatNumpyReads) {
  if (std::system("python3 -c 'import numpy' 2>/dev/null") != 0) {
    GTEST_SKIP() << "no numpy";
  }
  export_descriptors(folder_ / "a.npz", points_, whole_numbers());
  const std::string sum = std::to_string(whole_numbers().cast<int>().sum());
  const std::string command = "cd '" + folder_.string() + "' && python3 -c \"import numpy; a = numpy.load('a.npz'); " +
                              "assert a['features'].shape == (50, 7) and a['features'].dtype == numpy.int8; " +
                              "assert a['features'].sum(dtype=int) == " + sum +
                              "; assert a['xyz'].shape == (50, 3) and (a['xyz'][:, 2] == 1.5).all()\"";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(DescriptorExport, AnEmptyScanIsAFileToo) {
  export_descriptors(folder_ / "none.npz", {}, search::QuantizedDescriptors(0, 7));
  EXPECT_TRUE(read_descriptors(folder_ / "none.npz").points.empty());
  EXPECT_THROW(export_descriptors(folder_ / "x.npz", points_, search::QuantizedDescriptors(0, 7)),
               std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::features
