// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog_index.hpp"

#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <new>
#include <optional>

#include "guarded_child.hpp"
#include "gz_stream.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/mrpt_bridge/conversions.hpp"
#include "loopmark/storage/byte_stream.hpp"

namespace loopmark::mrpt_bridge::internal {
namespace {

using mrpt::obs::CObservation;

constexpr std::size_t kObjectMemory = std::size_t{1} << 31U;  // what reading one object may take

std::optional<ScanKind> kind_of(const CObservation& observation) {
  if (dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(&observation) != nullptr) {
    return ScanKind::kVelodyne;
  }
  if (dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation) != nullptr) {
    return ScanKind::kPointCloud;
  }
  return std::nullopt;
}

bool is_truth(const CObservation& observation) {
  return observation.sensorLabel == "truth" || observation.sensorLabel == "ground_truth";
}

void take(RawlogIndex& index, const CObservation& observation, RawlogEntry entry) {
  if (const auto* pose = dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation)) {
    if (is_truth(observation)) {
      index.truth.stamps_s.push_back(mrpt::Clock::toDouble(pose->timestamp));
      index.truth.poses.push_back(from_mrpt(pose->pose.mean));
    }
    return;
  }
  index.rotating_scans += dynamic_cast<const mrpt::obs::CObservationRotatingScan*>(&observation) != nullptr ? 1 : 0;
  const std::optional<ScanKind> kind = kind_of(observation);
  if (!kind || (index.label_chosen && observation.sensorLabel != index.label)) {
    return;
  }
  index.label = observation.sensorLabel;
  index.label_chosen = true;
  entry.stamp_s = mrpt::Clock::toDouble(observation.timestamp);
  entry.kind = *kind;
  index.entries.push_back(entry);
}

void read_through(const std::filesystem::path& path, RawlogIndex& index) {
  std::uint64_t offset = 0;
  const auto stopped = [&](const char* problem) {
    index.problem = std::string(problem) + " at byte " + std::to_string(offset) + " (uncompressed), behind object " +
                    std::to_string(index.objects);
  };
  try {
    GzStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    for (; !file.at_end() && !interrupt_requested(); ++index.objects) {
      offset = file.getPosition();
      const auto observations = observations_of(archive.ReadObject());
      for (std::size_t i = 0; i < observations.size(); ++i) {
        take(index, *observations[i], {offset, index.objects, i});
      }
    }
  } catch (const std::bad_alloc&) {
    stopped("damaged (a length beyond 2 GiB)");
  } catch (const std::exception&) {
    stopped("damaged or truncated");
  }
}

std::string to_bytes(const RawlogIndex& index) {
  storage::ByteWriter writer;
  writer.text(index.label);
  writer.value(index.label_chosen);
  writer.text(index.problem);
  writer.value(index.objects);
  writer.value(index.rotating_scans);
  writer.vector(index.entries);
  writer.vector(index.truth.stamps_s);
  for (const Pose& pose : index.truth.poses) {
    writer.raw(pose.matrix().data(), 16);
  }
  return writer.bytes();
}

RawlogIndex from_bytes(const std::string& bytes) {
  storage::ByteReader reader(bytes);
  RawlogIndex index;
  index.label = reader.text();
  index.label_chosen = reader.value<bool>();
  index.problem = reader.text();
  index.objects = reader.value<std::uint64_t>();
  index.rotating_scans = reader.value<std::uint64_t>();
  index.entries = reader.vector<RawlogEntry>();
  index.truth.stamps_s = reader.vector<double>();
  for (std::size_t i = 0; i < index.truth.stamps_s.size(); ++i) {
    reader.raw(index.truth.poses.emplace_back(Pose::Identity()).matrix().data(), 16);
  }
  return index;
}

}  // namespace

const char* class_name(ScanKind kind) {
  return kind == ScanKind::kVelodyne ? "CObservationVelodyneScan" : "CObservationPointCloud";
}

std::vector<CObservation::Ptr> observations_of(const mrpt::serialization::CSerializable::Ptr& object) {
  std::vector<CObservation::Ptr> observations;
  if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
    observations.assign(frame->begin(), frame->end());
  } else if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
    observations.push_back(observation);
  }
  std::erase(observations, nullptr);  // a frame may hold an object that is there in name only
  return observations;
}

RawlogIndex index_rawlog(const std::filesystem::path& path, const std::string& sensor_label) {
  const auto bytes = in_guarded_child(kObjectMemory, [&] {
    RawlogIndex index;
    index.label = sensor_label;
    index.label_chosen = !sensor_label.empty();
    read_through(path, index);
    return to_bytes(index);
  });
  check_interrupt();
  if (!bytes) {
    throw InputError(path.string(), "", "damaged in a way that MRPT does not survive", "record or copy it again");
  }
  RawlogIndex index = from_bytes(*bytes);
  if (index.objects == 0) {
    throw InputError(path.string(), "byte 0", "not a rawlog, or one that this version of MRPT cannot read");
  }
  return index;
}

}  // namespace loopmark::mrpt_bridge::internal
