// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What is where in a rawlog.
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/mrpt_bridge/rawlog.hpp"

namespace loopmark::mrpt_bridge::internal {

enum class ScanKind : std::uint8_t { kVelodyne, kPointCloud };
const char* class_name(ScanKind kind);

struct RawlogEntry {
  std::uint64_t offset = 0;    ///< of the object, uncompressed
  std::uint64_t object = 0;    ///< number of the object in the file
  std::uint64_t in_frame = 0;  ///< place within a sensory frame
  double stamp_s = 0.0;
  ScanKind kind = ScanKind::kVelodyne;
};

struct RawlogIndex {
  std::string label;
  bool label_chosen = false;
  std::string problem;  ///< behind the last usable object
  std::uint64_t objects = 0;
  std::uint64_t rotating_scans = 0;
  std::vector<RawlogEntry> entries;
  RawlogReader::Truth truth;
};

/// The observations of an object of a rawlog: of a sensory frame, or itself.
std::vector<mrpt::obs::CObservation::Ptr> observations_of(const mrpt::serialization::CSerializable::Ptr& object);

/// Reads the file once, in a process of its own: MRPT allocates what a length field claims before it reads, and one
/// object may claim 16 GB. What comes before such an object is kept. Throws InputError when the first object is none.
RawlogIndex index_rawlog(const std::filesystem::path& path, const std::string& sensor_label);

}  // namespace loopmark::mrpt_bridge::internal
