// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The files of the keyframes in a run folder.
#pragma once

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/places/place_descriptor.hpp"

namespace loopmark::map_store {

void write_keyframe_cloud(const RunFolder& folder, std::size_t number, const PointCloud& cloud);
PointCloud read_keyframe_cloud(const RunFolder& folder, std::size_t number);

/// The place descriptor of a cloud thinned as keyframes are; sensor's frame.
places::PlaceDescriptor place_of(const PointCloud& cloud);

/// The place descriptor of a keyframe's cloud.
void write_keyframe_place(const RunFolder& folder, std::size_t number, const PointCloud& cloud);
places::PlaceDescriptor read_keyframe_place(const RunFolder& folder, std::size_t number);

/// Cuts a record file back to its first `count` records.
void keep_records(const std::filesystem::path& path, std::size_t count);

}  // namespace loopmark::map_store
