// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <deque>
#include <mutex>

#include "gz_stream.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/mrpt_bridge/conversions.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"

namespace loopmark::mrpt_bridge {
namespace {

using mrpt::obs::CObservation;
using ObservationPtr = CObservation::Ptr;

/// Observations that are decoded ahead when scans are asked for in nearly the right order (by several threads).
constexpr std::size_t kReadAhead = 8;

struct Entry {
  std::uint64_t offset = 0;  ///< of the object, uncompressed
  std::size_t object = 0;    ///< number of the object in the file
  std::size_t in_frame = 0;  ///< place within a sensory frame
  double stamp_s = 0.0;
  const char* kind = "";
};

const char* kind_of(const CObservation& observation) {
  if (dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(&observation) != nullptr) {
    return "CObservationVelodyneScan";
  }
  if (dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation) != nullptr) {
    return "CObservationPointCloud";
  }
  return nullptr;
}

/// The observations of an object of a rawlog: of a sensory frame, or itself.
std::vector<ObservationPtr> observations_of(const mrpt::serialization::CSerializable::Ptr& object) {
  if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
    return {frame->begin(), frame->end()};
  }
  if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
    return {observation};
  }
  return {};
}

bool is_truth(const CObservation& observation) {
  return observation.sensorLabel == "truth" || observation.sensorLabel == "ground_truth";
}

}  // namespace

struct RawlogReader::State {
  std::filesystem::path path;
  std::string label;
  bool label_chosen = false;
  std::string problem;
  std::vector<Entry> entries;
  Truth truth;
  std::size_t rotating_scans = 0;

  std::mutex mutex;
  std::unique_ptr<internal::GzStream> stream;
  std::size_t next_entry = 0;  ///< the stream stands before or at this entry's object
  std::deque<std::pair<std::size_t, ObservationPtr>> recent;

  void index_file();
  void take(const ObservationPtr& observation, std::uint64_t offset, std::size_t object, std::size_t in_frame);
  ObservationPtr observation(std::size_t index);
};

void RawlogReader::State::take(const ObservationPtr& observation, std::uint64_t offset, std::size_t object,
                               std::size_t in_frame) {
  if (const auto pose = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(observation)) {
    if (is_truth(*observation)) {
      truth.stamps_s.push_back(mrpt::Clock::toDouble(pose->timestamp));
      truth.poses.push_back(from_mrpt(pose->pose.mean));
    }
    return;
  }
  rotating_scans += dynamic_cast<const mrpt::obs::CObservationRotatingScan*>(observation.get()) != nullptr ? 1 : 0;
  const char* const kind = kind_of(*observation);
  if (kind == nullptr || (label_chosen && observation->sensorLabel != label)) {
    return;
  }
  label = observation->sensorLabel;
  label_chosen = true;
  entries.push_back({offset, object, in_frame, mrpt::Clock::toDouble(observation->timestamp), kind});
}

void RawlogReader::State::index_file() {
  std::size_t object_number = 0;
  std::uint64_t offset = 0;
  try {
    internal::GzStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    for (; !file.at_end(); ++object_number) {
      check_interrupt();
      offset = file.getPosition();
      const auto observations = observations_of(archive.ReadObject());
      for (std::size_t i = 0; i < observations.size(); ++i) {
        take(observations[i], offset, object_number, i);
      }
    }
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception&) {
    if (object_number == 0) {
      throw InputError(path.string(), "byte 0", "not a rawlog, or one that this version of MRPT cannot read");
    }
    problem = "damaged or truncated at byte " + std::to_string(offset) + " (uncompressed), behind object " +
              std::to_string(object_number);
  }
}

ObservationPtr RawlogReader::State::observation(std::size_t index) {
  const std::scoped_lock lock(mutex);
  for (const auto& [number, observation] : recent) {
    if (number == index) {
      return observation;
    }
  }
  const bool ahead = stream && index >= next_entry;
  if (!ahead) {
    stream = std::make_unique<internal::GzStream>(path);
  }
  std::size_t from = ahead && index - next_entry < kReadAhead ? next_entry : index;
  auto archive = mrpt::serialization::archiveFrom(*stream);
  while (from <= index) {
    stream->Seek(static_cast<std::int64_t>(entries[from].offset));
    const auto observations = observations_of(archive.ReadObject());
    for (const std::uint64_t offset = entries[from].offset; from < entries.size() && entries[from].offset == offset;
         ++from) {
      recent.emplace_back(from, observations.at(entries[from].in_frame));
    }
  }
  next_entry = from;
  ObservationPtr wanted;
  for (const auto& [number, observation] : recent) {
    wanted = number == index ? observation : wanted;
  }
  while (recent.size() > kReadAhead) {
    recent.pop_front();
  }
  return wanted;
}

RawlogReader::RawlogReader(const std::filesystem::path& path, const std::string& sensor_label)
    : state_(std::make_unique<State>()) {
  state_->path = path;
  state_->label = sensor_label;
  state_->label_chosen = !sensor_label.empty();
  state_->index_file();
  if (state_->entries.empty()) {
    std::string problem = "no CObservationVelodyneScan or CObservationPointCloud";
    problem += sensor_label.empty() ? "" : " with the label '" + sensor_label + "'";
    problem += state_->rotating_scans == 0 ? "" : "; CObservationRotatingScan holds no elevation angles";
    throw InputError(path.string(), "", problem + (state_->problem.empty() ? "" : "; " + state_->problem));
  }
}

RawlogReader::~RawlogReader() = default;

std::size_t RawlogReader::size() const { return state_->entries.size(); }
double RawlogReader::stamp_s(std::size_t index) const { return state_->entries.at(index).stamp_s; }
const std::string& RawlogReader::sensor_label() const { return state_->label; }
const std::string& RawlogReader::problem() const { return state_->problem; }
const RawlogReader::Truth& RawlogReader::truth() const { return state_->truth; }

std::string RawlogReader::place(std::size_t index) const {
  const Entry& entry = state_->entries.at(index);
  return "object " + std::to_string(entry.object) + ", " + entry.kind;
}

PointCloud RawlogReader::read(std::size_t index) const {
  try {
    const ObservationPtr observation = state_->observation(index);
    // Points in files of their own lie beside the rawlog; where is a global setting of MRPT.
    const std::scoped_lock lock(state_->mutex);
    mrpt::io::setLazyLoadPathBase(mrpt::obs::CRawlog::detectImagesDirectory(state_->path.string()));
    return cloud_from_observation(*observation).value();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(state_->path.string(), place(index), error.what());
  }
}

}  // namespace loopmark::mrpt_bridge
