// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "recording_log.hpp"

#include <algorithm>
#include <mutex>
#include <set>

#include "file_log.hpp"
#include "layout_parts.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/recorded_log.hpp"
#include "point_times.hpp"
#include "recording_index.hpp"
#include "recording_observations.hpp"

namespace loopmark::io::internal {
namespace fs = std::filesystem;
namespace {

constexpr double kNanosecond = 1e-9;

/// True where the headers' stamps can be the scans' times: most of them differ, and none but few are 0.
bool stamps_make_sense(const std::vector<StampedMessage>& messages) {
  std::set<std::int64_t> different;
  for (const StampedMessage& m : messages) {
    if (m.header_ns != 0) {
      different.insert(m.header_ns);
    }
  }
  return messages.size() == 1 || 10 * different.size() >= 9 * (messages.size() - 1);
}

TopicFacts facts_of(const IndexedTopic& topic) {
  TopicFacts facts;
  facts.topic = topic.channel.topic;
  facts.type = topic.channel.type;
  facts.messages = topic.messages;
  facts.bytes = topic.bytes;
  facts.first_s = kNanosecond * static_cast<double>(topic.first_ns);
  facts.last_s = kNanosecond * static_cast<double>(topic.last_ns);
  facts.has_scans = topic.cloud != nullptr;
  facts.problem = topic.problem;
  return facts;
}

class RecordingLog : public RecordedLog {
 public:
  RecordingLog(std::unique_ptr<recordings::Recording> recording, const fs::path& path, const LogOptions& options)
      : recording_(std::move(recording)), options_(options) {
    RecordingIndex index = index_recording(*recording_);
    info_.path = path;
    info_.format = recording_->format();
    const std::size_t chosen = choose_topic(index, options, path.string(), facts_.topic_reason);
    for (const IndexedTopic& topic : index.topics) {
      facts_.topics.push_back(facts_of(topic));
    }
    for (const std::string& problem : index.problems) {
      info_.problem += (info_.problem.empty() ? "" : "; ") + problem;
      log(Severity::kWarning, problem);
    }
    take_topic(index.topics[chosen]);
    facts_.mounts = mounts_of(index, facts_.frame_id);
    take_truth(index);
  }

  std::size_t size() const override { return messages_.size(); }
  double stamp_s(std::size_t index) const override { return stamps_s_.at(index); }
  std::string scan_name(std::size_t index) const override {
    return file_of(index).string() + ":" + facts_.topic + " message " + std::to_string(index);
  }
  fs::path scan_file(std::size_t index) const override { return file_of(index); }
  Scan read(std::size_t index) const override { return read_closely(index).scan; }
  const LogInfo& info() const override { return info_; }
  const RecordingFacts& recording() const override { return facts_; }
  std::vector<Pose> truth() const override { return truth_; }

  void visit_observations(const ObservationVisitor& visit) const override {
    const std::lock_guard lock(walk_mutex_);
    visit_recording(*recording_, visit);
  }

  ScanReading read_closely(std::size_t index) const override {
    PointFile file;
    try {
      file = decoder_->decode(recording_->read(messages_.at(index).ref));
    } catch (const InputError& error) {
      throw DamagedScan(scan_name(index) + ": " + error.what());
    }
    if (file.first_time_s) {
      refer_to_stamp(file.cloud.time_offset_s, *file.first_time_s, stamp_s(index));
    }
    ScanReading reading{{index, stamp_s(index), std::move(file.cloud)}, file.dropped, false, false};
    finish_reading(reading, scan_name(index), info_, options_);
    return reading;
  }

 private:
  const fs::path& file_of(std::size_t index) const { return recording_->files().at(messages_.at(index).ref.file); }

  void take_topic(IndexedTopic& topic) {
    messages_ = std::move(topic.index);
    facts_.topic = topic.channel.topic;
    const bool headers = stamps_make_sense(messages_);
    if (!headers) {
      for (StampedMessage& m : messages_) {
        m.header_ns = m.ref.time_ns;
      }
    }
    // Split files and parallel writers may leave messages out of order; stamps that go back a little are put in order,
    // and with them their scans.
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const StampedMessage& a, const StampedMessage& b) { return a.ref.time_ns < b.ref.time_ns; });
    for (const StampedMessage& m : messages_) {
      stamps_s_.push_back(kNanosecond * static_cast<double>(m.header_ns));
    }
    info_.stamps_given = true;
    info_.stamps_source = headers ? "the messages' headers" : "the recording (the messages' headers have none)";
    const std::string problem = repair_timestamps(stamps_s_, info_.path);
    info_.problem += (info_.problem.empty() || problem.empty() ? "" : "; ") + problem;
    decoder_ = topic.cloud->learn(samples_of(topic), options_);
    facts_.topic_content = decoder_->describe();
    facts_.frame_id = decoder_->frame_id();
  }

  /// Reference poses where the recording has a topic of that name.
  void take_truth(const RecordingIndex& index) {
    FileLogParts parts;
    parts.stamps_s = stamps_s_;
    std::vector<double> stamps;
    std::vector<Pose> poses;
    for (const KeptMessage& message : index.kept) {
      const auto seen = observation_of(index.topics[message.channel].channel, message.time_ns, message.bytes);
      const auto* sample = seen ? std::get_if<OdometrySample>(&*seen) : nullptr;
      if (sample != nullptr) {
        stamps.push_back(sample->source.stamp_s);
        poses.push_back(sample->T_frame_child);
      }
    }
    if (poses.empty()) {
      return;
    }
    take_truth_interpolated(parts, stamps, poses, info_.path.string() + ":" + kTruthTopic);
    truth_ = std::move(parts.truth);
    info_.truth_given = parts.info.truth_given;
    info_.truth_source = parts.info.truth_source;
    info_.truth_problem = parts.info.truth_problem;
  }

  MessageSamples samples_of(const IndexedTopic& topic) const {
    constexpr std::size_t kSamples = 5;
    MessageSamples samples{topic.channel, info_.path, {}};
    std::string problem;
    for (std::size_t k = 0; k < std::min(kSamples, messages_.size()); ++k) {
      const std::size_t i = messages_.size() <= kSamples ? k : k * (messages_.size() - 1) / (kSamples - 1);
      try {
        samples.messages.push_back(recording_->read(messages_[i].ref));
      } catch (const InputError& error) {
        problem = error.what();
      }
    }
    if (samples.messages.empty()) {
      throw InputError(problem);
    }
    return samples;
  }

  std::unique_ptr<recordings::Recording> recording_;
  LogOptions options_;
  LogInfo info_;
  RecordingFacts facts_;
  std::vector<StampedMessage> messages_;
  std::vector<double> stamps_s_;
  std::vector<Pose> truth_;
  std::unique_ptr<CloudDecoder> decoder_;
  mutable std::mutex walk_mutex_;
};

}  // namespace

LogPointer open_recording_log(std::unique_ptr<recordings::Recording> recording, const fs::path& path,
                              const LogOptions& options) {
  return std::make_unique<RecordingLog>(std::move(recording), path, options);
}

fs::path only_recording(const fs::path& path, bool (*is_one)(const fs::path&)) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    return is_one(path) ? path : fs::path();
  }
  fs::path found;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    if (!it->is_regular_file(error) || !is_one(it->path())) {
      continue;
    }
    if (!found.empty()) {
      throw InputError(path.string(), "", "several recordings in this folder", "name one of the files");
    }
    found = it->path();
  }
  return found;
}

}  // namespace loopmark::io::internal
