// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The files of the keyframes in a run folder.
#pragma once

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/places/place_signature.hpp"
#include "loopmark/slam/run_folder.hpp"

namespace loopmark {

void write_keyframe_cloud(const RunFolder& folder, std::size_t number, const PointCloud& cloud);
PointCloud read_keyframe_cloud(const RunFolder& folder, std::size_t number);

/// The place signature of a cloud thinned as keyframes are; sensor's frame.
PlaceSignature place_of(const PointCloud& cloud);

/// The place signature of a keyframe's cloud.
void write_keyframe_place(const RunFolder& folder, std::size_t number, const PointCloud& cloud);
PlaceSignature read_keyframe_place(const RunFolder& folder, std::size_t number);

/// Cuts a record file back to its first `count` records.
void keep_records(const std::filesystem::path& path, std::size_t count);

}  // namespace loopmark
