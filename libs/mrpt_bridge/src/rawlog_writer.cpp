// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>

#include <memory>

#include "gz_stream.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/mrpt_bridge/conversions.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"

namespace loopmark::mrpt_bridge {
namespace fs = std::filesystem;

struct RawlogWriter::State {
  fs::path path;
  fs::path partial;
  std::string label;
  std::unique_ptr<internal::GzOutput> file;  ///< none once finished

  void write(const mrpt::serialization::CSerializable& object) {
    try {
      mrpt::serialization::archiveFrom(*file) << object;
    } catch (const std::exception&) {
      throw InputError(partial.string(), "", "cannot write", "is the disk full?");
    }
  }
};

RawlogWriter::RawlogWriter(fs::path path, std::string sensor_label) : state_(std::make_unique<State>()) {
  state_->partial = path.string() + ".partial";
  state_->path = std::move(path);
  state_->label = std::move(sensor_label);
  try {
    state_->file = std::make_unique<internal::GzOutput>(state_->partial);
  } catch (const std::exception&) {
    throw InputError(state_->path.string(), "", "cannot write", "does the folder exist, and may you write there?");
  }
}

RawlogWriter::~RawlogWriter() {
  if (state_->file) {
    state_->file.reset();
    std::error_code error;
    fs::remove(state_->partial, error);
  }
}

void RawlogWriter::add(const Scan& scan, const std::optional<Pose>& truth) {
  const auto observation = observation_from_scan(scan, state_->label);
  if (truth) {
    mrpt::obs::CObservationRobotPose pose;
    pose.timestamp = observation->timestamp;
    pose.sensorLabel = "truth";
    pose.pose.mean = to_mrpt(*truth);
    state_->write(pose);
  }
  state_->write(*observation);
}

void RawlogWriter::finish() {
  try {
    state_->file->close();
  } catch (const std::exception&) {
    throw InputError(state_->partial.string(), "", "cannot write", "is the disk full?");
  }
  state_->file.reset();
  std::error_code error;
  fs::rename(state_->partial, state_->path, error);
  if (error) {
    throw InputError(state_->path.string(), "", "cannot write: " + error.message());
  }
}

}  // namespace loopmark::mrpt_bridge
