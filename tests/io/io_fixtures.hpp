// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Small clouds and folders for the tests of reading and writing.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::testing {

namespace fs = std::filesystem;

/// A folder of its own for one test, gone afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = fs::temp_directory_path() /
            ("loopmark_" + std::to_string(::getpid()) + "_" + test->test_suite_name() + "_" + test->name());
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  const fs::path& path() const { return path_; }
  fs::path operator/(const std::string& name) const { return path_ / name; }

  /// Writes a file (and its folders) below the folder.
  fs::path write(const std::string& name, const std::string& content) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  fs::path path_;
};

/// A cloud of `count` points within 50 m with every channel.
inline PointCloud random_cloud(std::size_t count, std::uint64_t seed = 1) {
  Rng rng(seed);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.emplace_back(static_cast<float>(rng.uniform(-50, 50)), static_cast<float>(rng.uniform(-50, 50)),
                              static_cast<float>(rng.uniform(-3, 10)));
    cloud.intensity.push_back(static_cast<float>(rng.below(256)));
    cloud.ring.push_back(static_cast<std::uint16_t>(rng.below(64)));
    cloud.time_offset_s.push_back(static_cast<float>(0.1 * static_cast<double>(i) / static_cast<double>(count)));
  }
  return cloud;
}

/// The bytes of a value, as binary files hold it.
template <class T>
std::string bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// The message of the exception of type E that `action` throws; a failure when it throws none.
template <class E, class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const E& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

}  // namespace loopmark::testing
