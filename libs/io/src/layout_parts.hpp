// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the layouts on disk have in common: files in order, their stamps, the reference poses beside them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "file_log.hpp"

namespace loopmark::io::internal {

/// Point files of a folder in numeric order: of the kind (.bin, .pcd, .ply) that is there most often. Empty
/// when there are none or the folder is none.
std::vector<std::filesystem::path> list_point_files(const std::filesystem::path& folder);

/// Sub-folders in numeric order; empty when there are none or the folder is none.
std::vector<std::filesystem::path> list_folders(const std::filesystem::path& folder);

/// "bin", "pcd" or "ply".
std::string point_file_kind(const std::filesystem::path& file);

/// Fills files, frame_numbers (from the names, else from 0), options and the sweep model that the options or
/// a sweep.txt in `base` ask for; then stamps from the names, else from the rate.
FileLogParts parts_of_files(std::vector<std::filesystem::path> files, const std::filesystem::path& base,
                            const LogOptions& options);

/// Replaces the stamps by those of a file with one stamp a line (seconds, or "2011-09-26 13:02:25.9511"), when
/// there is one. Throws InputError when its length fits neither the scans nor their numbers.
void take_stamps(FileLogParts& parts, const std::filesystem::path& file);

/// Replaces times that repeat or go back (all but a longest rising subsequence) by times between their neighbours'.
/// Returns what was wrong and warns of it; empty when nothing is.
std::string repair_timestamps(std::vector<double>& stamps_s, const std::filesystem::path& file);

/// Takes reference poses (one a scan) when the file is there; lengths that do not fit become truth_problem and
/// a warning. `to_lidar` makes a T_world_lidar of each pose.
void take_truth(FileLogParts& parts, const std::filesystem::path& file,
                const std::optional<Pose>& T_camera_lidar = std::nullopt);

/// The same with poses at other stamps, interpolated.
void take_truth_interpolated(FileLogParts& parts, const std::vector<double>& stamps_s, const std::vector<Pose>& poses,
                             const std::string& source);

/// The row of a table with `rows` rows that belongs to each scan: row i to scan i where there are as many, else
/// the row of the scan's number; nothing when neither fits.
std::optional<std::vector<std::size_t>> rows_of_scans(const FileLogParts& parts, std::size_t rows);

/// The stamp in a file's name: digits since 1970 in ns or us, seconds with a fraction, or a date
/// 2021-10-26-16-21-29-468. Nothing when there is none.
/// The times in the names of all files, seconds; nothing where a name has none. Fractions of unequal length in one
/// folder are whole nanoseconds that nobody padded.
std::vector<double> stamps_in_names(const std::vector<std::filesystem::path>& files);

std::optional<double> stamp_in_name(const std::filesystem::path& file);

/// "2011-09-26 13:02:25.951199337" or with other separators, as seconds since 1970 (UTC).
std::optional<double> parse_date_time(std::string_view text);

}  // namespace loopmark::io::internal
