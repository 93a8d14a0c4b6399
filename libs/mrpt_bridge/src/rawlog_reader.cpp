// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/serialization/CArchive.h>

#include <deque>
#include <mutex>

#include "gz_stream.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/mrpt_bridge/conversions.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"
#include "rawlog_index.hpp"

namespace loopmark::mrpt_bridge {
namespace {

using ObservationPtr = mrpt::obs::CObservation::Ptr;

/// Observations that are decoded ahead when scans are asked for in nearly the right order (by several threads).
constexpr std::size_t kReadAhead = 8;

}  // namespace

struct RawlogReader::State {
  std::filesystem::path path;
  internal::RawlogIndex index;

  std::mutex mutex;
  std::unique_ptr<internal::GzStream> stream;
  std::size_t next_entry = 0;  ///< the stream stands before or at this entry's object
  std::deque<std::pair<std::size_t, ObservationPtr>> recent;

  ObservationPtr observation(std::size_t wanted);
};

ObservationPtr RawlogReader::State::observation(std::size_t wanted) {
  const std::scoped_lock lock(mutex);
  for (const auto& [number, observation] : recent) {
    if (number == wanted) {
      return observation;
    }
  }
  const std::vector<internal::RawlogEntry>& entries = index.entries;
  const bool ahead = stream && wanted >= next_entry;
  if (!ahead) {
    stream = std::make_unique<internal::GzStream>(path);
  }
  std::size_t from = ahead && wanted - next_entry < kReadAhead ? next_entry : wanted;
  auto archive = mrpt::serialization::archiveFrom(*stream);
  while (from <= wanted) {
    stream->Seek(static_cast<std::int64_t>(entries[from].offset));
    const auto observations = internal::observations_of(archive.ReadObject());
    for (const std::uint64_t offset = entries[from].offset; from < entries.size() && entries[from].offset == offset;
         ++from) {
      recent.emplace_back(from, observations.at(entries[from].in_frame));
    }
  }
  next_entry = from;
  ObservationPtr found;
  for (const auto& [number, observation] : recent) {
    found = number == wanted ? observation : found;
  }
  while (recent.size() > kReadAhead) {
    recent.pop_front();
  }
  return found;
}

RawlogReader::RawlogReader(const std::filesystem::path& path, const std::string& sensor_label)
    : state_(std::make_unique<State>()) {
  state_->path = path;
  state_->index = internal::index_rawlog(path, sensor_label);
  const internal::RawlogIndex& index = state_->index;
  if (index.entries.empty()) {
    std::string problem = "no CObservationVelodyneScan or CObservationPointCloud";
    problem += sensor_label.empty() ? "" : " with the label '" + sensor_label + "'";
    problem += index.rotating_scans == 0 ? "" : "; CObservationRotatingScan holds no elevation angles";
    throw InputError(path.string(), "", problem + (index.problem.empty() ? "" : "; " + index.problem));
  }
}

RawlogReader::~RawlogReader() = default;

std::size_t RawlogReader::size() const { return state_->index.entries.size(); }
double RawlogReader::stamp_s(std::size_t index) const { return state_->index.entries.at(index).stamp_s; }
const std::string& RawlogReader::sensor_label() const { return state_->index.label; }
const std::string& RawlogReader::problem() const { return state_->index.problem; }
const RawlogReader::Truth& RawlogReader::truth() const { return state_->index.truth; }

std::string RawlogReader::place(std::size_t index) const {
  const internal::RawlogEntry& entry = state_->index.entries.at(index);
  return "object " + std::to_string(entry.object) + ", " + internal::class_name(entry.kind);
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
