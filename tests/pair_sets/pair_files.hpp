// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Small sets and folders for the tests of the evaluation room.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/core/random.hpp"
#include "loopmark/pair_sets/pair_set.hpp"

namespace loopmark::test {

/// A folder that vanishes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int counter = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("loopmark_evaluation_" + std::to_string(::getpid()) + "_" + std::to_string(counter++));
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline Pose random_motion(Rng& rng, double distance_m = 40.0) {
  Pose pose = Pose::Identity();
  pose.linear() =
      rotation_from_euler_degrees({rng.uniform(-4.0, 4.0), rng.uniform(-4.0, 4.0), rng.uniform(-180.0, 180.0)});
  pose.translation() = Eigen::Vector3d(rng.uniform(-distance_m, distance_m), rng.uniform(-distance_m, distance_m),
                                       rng.uniform(-1.0, 1.0));
  return pose;
}

inline std::vector<pair_sets::RegistrationPair> random_pairs(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<pair_sets::RegistrationPair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const int source = static_cast<int>(i) * 3;
    const int session = static_cast<int>(i % 2);
    const double overlap = rng.uniform(0.2, 0.9);
    pairs.push_back(
        pair_sets::make_pair({session, source, source + 1, session}, random_motion(rng), overlap, 0.9 * overlap));
  }
  return pairs;
}

/// Where column `index` (from 0) of a line starts.
inline std::size_t column_start(const std::string& line, std::size_t index) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < index; ++i) {
    at = line.find(' ', at) + 1;
  }
  return at;
}

}  // namespace loopmark::test
