// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Where the messages of a recording's topics lie, found in one walk, and which topic holds the scans.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cloud_message.hpp"
#include "loopmark/recordings/recording.hpp"

namespace loopmark::io::internal {

/// A message with the stamp of its header.
struct StampedMessage {
  recordings::MessageRef ref;
  std::int64_t header_ns = 0;
};

struct IndexedTopic {
  recordings::Channel channel;
  const CloudMessage* cloud = nullptr;  ///< where its messages are scans
  std::string problem;                  ///< why they cannot be read although they are
  std::size_t messages = 0;
  std::uint64_t bytes = 0;
  std::int64_t first_ns = 0, last_ns = 0;  ///< when it was recorded
  std::vector<StampedMessage> index;       ///< of topics with scans only
};

/// A message that is kept whole: static transforms and reference poses, which are few and small.
struct KeptMessage {
  std::uint32_t channel = 0;
  std::int64_t time_ns = 0;
  std::string bytes;
};

struct RecordingIndex {
  std::vector<KeptMessage> kept;
  std::vector<IndexedTopic> topics;  ///< one for each of Recording::channels()
  std::vector<std::string> problems;
};

RecordingIndex index_recording(recordings::Recording& recording);

/// The topic that options.sensor_label names, or the one that holds the drive's scans most probably. `why` says so.
/// Throws InputError, with what is there, when there is none or the named one cannot be read.
std::size_t choose_topic(const RecordingIndex& index, const LogOptions& options, const std::string& file,
                         std::string& why);

}  // namespace loopmark::io::internal
