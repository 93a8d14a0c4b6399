// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// A real drive whose scans are not motion-compensated. Oracle: reference motions between its scans, up to 45 m apart,
// found by others than the odometry (registration of deskewed scans, checked several ways).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "app/sweep_logs.hpp"
#include "support/shared_data.hpp"

namespace loopmark::app {
namespace {

struct ReferencePair {
  std::size_t source = 0;
  std::size_t target = 0;
  Pose T_target_source = Pose::Identity();
};

/// The pairs of one log: "session i j", a 4 x 4 matrix row by row, and more that is not needed here.
std::vector<ReferencePair> pairs_of(const std::filesystem::path& file, std::size_t log) {
  std::vector<ReferencePair> pairs;
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream words(line);
    std::size_t session = 0;
    ReferencePair pair;
    words >> session >> pair.source >> pair.target;
    for (int k = 0; k < 16; ++k) {
      words >> pair.T_target_source.matrix()(k / 4, k % 4);
    }
    if (words && session == log) {
      pairs.push_back(pair);
    }
  }
  return pairs;
}

TEST(MapAccuracy, OfARealCityDriveWithRawSweeps) {
  const auto log = testing_support::unpacked_log("kitti_raw_city");
  const auto file = testing_support::shared_path("logs/real_pairs/pairs.txt");
  if (!log || !file) {
    GTEST_SKIP() << "no shared logs";
  }
  const testing_support::StreetLogs places{"map_accuracy_test"};
  const std::filesystem::path run = places.new_run("run");
  const auto result = testing_support::run_program({"map", *log, "-o", run, "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const std::vector<Pose> found = io::read_trajectory(run / "trajectory.kitti").poses;
  ASSERT_EQ(found.size(), 154U);
  const std::vector<ReferencePair> pairs = pairs_of(*file, 0);
  ASSERT_EQ(pairs.size(), 90U);
  std::vector<double> errors_m;
  for (const ReferencePair& pair : pairs) {
    const PoseError error = pose_error(found[pair.target].inverse() * found[pair.source], pair.T_target_source);
    EXPECT_LT(error.translation_m, 0.6) << pair.source << " " << pair.target;
    EXPECT_LT(error.rotation_deg, 5.0) << pair.source << " " << pair.target;
    errors_m.push_back(error.translation_m);
  }
  std::nth_element(errors_m.begin(), errors_m.begin() + 45, errors_m.end());
  EXPECT_LT(errors_m[45], 0.10);
}

}  // namespace
}  // namespace loopmark::app
