// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The readers of what others made, each as a function of bytes. A reader may throw InputError; anything else that it
/// does (another exception, a sanitizer's report, memory without end) is a finding.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace loopmark::fuzz {

struct Target {
  const char* name;  ///< of its seeds (fuzz/seeds/NAME) and dictionary (fuzz/dictionaries/NAME.dict)
  void (*read)(std::string_view bytes);
};

void point_file(std::string_view bytes);        ///< PCD, PLY, .bin
void log_folder(std::string_view bytes);        ///< times, poses, calibration, sweep beside scans
void trajectory(std::string_view bytes);        ///< TUM, KITTI
void yaml(std::string_view bytes);              ///< options
void descriptors(std::string_view bytes);       ///< .npz
void run_records(std::string_view bytes);       ///< scans, loops, drives, decisions of a run, with right checksums
void prepared_scan(std::string_view bytes);     ///< with a right checksum
void place_descriptor(std::string_view bytes);  ///< with a right checksum
void saved_state(std::string_view bytes);       ///< of the odometry, with a right checksum
void result_records(std::string_view bytes);    ///< experiment, outcomes, times of an evaluation
void pair_set(std::string_view bytes);          ///< pairs, negatives, motions
void pose_graph(std::string_view bytes);        ///< g2o

inline const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
      {"point_file", point_file},       {"log_folder", log_folder},
      {"trajectory", trajectory},       {"yaml", yaml},
      {"descriptors", descriptors},     {"run_records", run_records},
      {"prepared_scan", prepared_scan}, {"place_descriptor", place_descriptor},
      {"saved_state", saved_state},     {"result_records", result_records},
      {"pair_set", pair_set},           {"pose_graph", pose_graph},
  };
  return all;
}

}  // namespace loopmark::fuzz
