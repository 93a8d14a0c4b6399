// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "recording_index.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/messages/definitions.hpp"
#include "loopmark/text/text.hpp"
#include "recording_observations.hpp"

namespace loopmark::io::internal {
namespace {

/// A header begins at byte 4 of a message: behind CDR's encapsulation, or behind ROS 1's sequence number.
constexpr std::size_t kStampBytes = 12;
constexpr std::size_t kMostKept = std::size_t{64} << 20U;  // bytes of messages kept whole: a day of poses
constexpr std::size_t kProgressStep = 4096;                // messages between looks at the user's wish to stop

bool is_kept(const recordings::Channel& channel) {
  return is_static_transform(channel) || channel.topic == kTruthTopic;
}

std::int64_t header_stamp(std::string_view head) {
  std::uint32_t seconds = 0, nanoseconds = 0;
  std::memcpy(&seconds, head.data() + 4, 4);
  std::memcpy(&nanoseconds, head.data() + 8, 4);
  return std::int64_t{seconds} * 1'000'000'000 + nanoseconds;
}

std::string problem_of(const recordings::Channel& channel) {
  if (channel.encoding == recordings::Encoding::kOther) {
    return "its messages are encoded as '" + channel.encoding_name + "', which is neither cdr nor ros1";
  }
  return messages::definition_problem(channel);
}

/// Clouds that something made of the scans, by the usual names of their topics.
bool made_from_scans(const std::string& topic) {
  const std::string name = text::lower_case(topic);
  static constexpr std::array kWords = {"map",     "registered", "filter",         "ground",  "obstacle", "downsample",
                                        "cluster", "segment",    "cloud_effected", "feature", "corner",   "surf",
                                        "global",  "local_",     "depth",          "camera",  "radar"};
  return std::any_of(kWords.begin(), kWords.end(), [&](const char* w) { return name.find(w) != std::string::npos; });
}

/// What speaks for a topic, the weightier first: readable, not made from scans, many messages, clouds before packets,
/// many bytes.
auto rank_of(const IndexedTopic& t, std::size_t most_messages) {
  return std::tuple(t.problem.empty(), t.messages > 0, !made_from_scans(t.channel.topic),
                    2 * t.messages >= most_messages, t.cloud->worth, t.bytes);
}

std::string list_of(const RecordingIndex& index) {
  std::string text;
  for (const IndexedTopic& t : index.topics) {
    text +=
        (text.empty() ? "" : ", ") + t.channel.topic + " (" + t.channel.type + ", " + std::to_string(t.messages) + ")";
    if (text.size() > 1500) {
      return text + ", ...";
    }
  }
  return text.empty() ? "no topic at all" : text;
}

std::string types_known() {
  std::string text;
  for (const CloudMessage& m : cloud_messages()) {
    text += (text.empty() ? "" : ", ") + m.type;
  }
  return text;
}

std::size_t named_topic(const RecordingIndex& index, const std::string& name, const std::string& file) {
  for (std::size_t i = 0; i < index.topics.size(); ++i) {
    const IndexedTopic& t = index.topics[i];
    if (t.channel.topic != name && t.channel.topic != "/" + name) {
      continue;
    }
    if (t.cloud == nullptr) {
      throw InputError(file, "topic " + name, "its messages are " + t.channel.type + ", which are no scans",
                       "scans are: " + types_known());
    }
    if (!t.problem.empty() || t.messages == 0) {
      throw InputError(file, "topic " + name, t.problem.empty() ? "no message was recorded" : t.problem);
    }
    return i;
  }
  throw InputError(file, "", "no topic '" + name + "'", "there are: " + list_of(index));
}

}  // namespace

RecordingIndex index_recording(recordings::Recording& recording) {
  RecordingIndex index;
  Progress progress("messages", 0);
  std::size_t seen = 0;
  const auto topic_of = [&](std::uint32_t channel) -> IndexedTopic& {
    while (index.topics.size() <= channel) {
      IndexedTopic topic;
      topic.channel = recording.channels()[index.topics.size()];
      topic.cloud = find_cloud_message(topic.channel.type);
      topic.problem = topic.cloud == nullptr ? "" : problem_of(topic.channel);
      index.topics.push_back(std::move(topic));
    }
    return index.topics[channel];
  };
  const auto wanted = [](const recordings::Channel& channel) {
    if (is_kept(channel)) {
      return recordings::kAllBytes;
    }
    return find_cloud_message(channel.type) == nullptr ? std::size_t{0} : kStampBytes;
  };
  std::size_t kept_bytes = 0;
  recording.walk(wanted, [&](const recordings::MessageRef& message, std::string_view head) {
    if (++seen % kProgressStep == 0) {
      check_interrupt();
      progress.add(kProgressStep);
    }
    IndexedTopic& topic = topic_of(message.channel);
    topic.first_ns = topic.messages == 0 ? message.time_ns : std::min(topic.first_ns, message.time_ns);
    topic.last_ns = topic.messages == 0 ? message.time_ns : std::max(topic.last_ns, message.time_ns);
    ++topic.messages;
    topic.bytes += message.size;
    if (is_kept(topic.channel) && kept_bytes < kMostKept) {
      kept_bytes += head.size();
      index.kept.push_back({message.channel, message.time_ns, std::string(head)});
    }
    if (topic.cloud != nullptr) {
      topic.index.push_back({message, head.size() < kStampBytes ? 0 : header_stamp(head)});
    }
  });
  for (std::uint32_t i = 0; i < recording.channels().size(); ++i) {
    topic_of(i);
  }
  index.problems = recording.problems();
  return index;
}

std::size_t choose_topic(const RecordingIndex& index, const LogOptions& options, const std::string& file,
                         std::string& why) {
  if (!options.sensor_label.empty()) {
    why = "asked for";
    return named_topic(index, options.sensor_label, file);
  }
  std::size_t most = 0, clouds = 0, best = index.topics.size();
  for (const IndexedTopic& t : index.topics) {
    most = std::max(most, t.cloud != nullptr ? t.messages : 0);
    clouds += t.cloud != nullptr && t.messages > 0 ? 1 : 0;
  }
  for (std::size_t i = 0; i < index.topics.size(); ++i) {
    const IndexedTopic& t = index.topics[i];
    if (t.cloud != nullptr && (best == index.topics.size() || rank_of(t, most) > rank_of(index.topics[best], most))) {
      best = i;
    }
  }
  const std::string damage = index.problems.empty() ? "" : " (" + index.problems.front() + ")";
  if (best == index.topics.size() || index.topics[best].messages == 0) {
    throw InputError(file, "", "no topic with scans" + damage,
                     "scans are: " + types_known() + "; there are: " + list_of(index));
  }
  if (!index.topics[best].problem.empty()) {
    throw InputError(file, "topic " + index.topics[best].channel.topic, index.topics[best].problem);
  }
  why = clouds == 1 ? "the only one with scans"
                    : "of " + std::to_string(clouds) + " with scans the one with most data; --topic chooses another";
  return best;
}

}  // namespace loopmark::io::internal
