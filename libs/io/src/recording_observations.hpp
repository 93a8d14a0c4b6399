// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// IMU, GNSS, odometry and mountings of a recording.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "loopmark/io/observations.hpp"
#include "recording_index.hpp"

namespace loopmark::io::internal {

/// The topic with reference poses, where logs are read and written.
inline constexpr const char* kTruthTopic = "/ground_truth";

bool is_static_transform(const recordings::Channel& channel);

/// What a message says; nothing for other messages and for those that cannot be read.
std::optional<Observation> observation_of(const recordings::Channel& channel, std::int64_t time_ns,
                                          std::string_view bytes);

/// All observations of a recording.
void visit_recording(recordings::Recording& recording, const ObservationVisitor& visit);

/// T_base_frame of every frame that the static transforms connect with `base`.
std::map<std::string, Pose> mounts_of(const RecordingIndex& index, const std::string& base);

}  // namespace loopmark::io::internal
