// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// From columns of numbers, as point files hold them, to a cloud without the points that make no sense.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "loopmark/io/point_files.hpp"
#include "time_rule.hpp"

namespace loopmark::io::internal {

enum class NumberType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

std::size_t size_of(NumberType type);

/// One channel of the points: little-endian numbers `stride` bytes apart.
struct Column {
  const char* data = nullptr;
  std::size_t stride = 0;
  NumberType type = NumberType::kFloat32;

  bool empty() const { return data == nullptr; }
};

/// The columns of a cloud; x, y and z must be there.
struct PointColumns {
  Column x, y, z, intensity, ring, time;
  std::size_t count = 0;
};

/// The column that a field of this name fills ("i" -> intensity); nullptr for an unknown name.
Column* column_for_field(PointColumns& columns, std::string_view field_name);

/// Copies what is usable. Times become seconds: by the rule where there is one (it is known from other scans of the
/// log too), else by the scan itself (see interpret_times).
PointFile decode_points(const PointColumns& columns, const LogOptions& options, const TimeRule* rule = nullptr);

/// The values of the time column, of the points that decode_points keeps only: drivers leave the times of points
/// without echo unset.
std::vector<double> times_of_usable_points(const PointColumns& columns, const LogOptions& options);

/// The cloud without its senseless points, which are counted.
PointCloud filter_invalid(PointCloud cloud, const LogOptions& options, DroppedPoints& dropped);

/// Throws DamagedScan with `file` unless x, y and z are there.
void require_coordinates(const PointColumns& columns, const std::string& file);

}  // namespace loopmark::io::internal
