// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>

#include "loopmark/text/text.hpp"
#include "point_times.hpp"

namespace loopmark::io::internal {
namespace {

template <class T, class Out>
void copy_as(const Column& column, std::span<const std::uint32_t> kept, Out* out) {
  for (std::size_t i = 0; i < kept.size(); ++i) {
    T value;
    std::memcpy(&value, column.data + kept[i] * column.stride, sizeof value);
    out[i] = static_cast<Out>(value);
  }
}

/// Copies the kept rows of a column of any number type.
template <class Out>
void copy_column(const Column& column, std::span<const std::uint32_t> kept, Out* out) {
  switch (column.type) {
    case NumberType::kInt8:
      return copy_as<std::int8_t>(column, kept, out);
    case NumberType::kUint8:
      return copy_as<std::uint8_t>(column, kept, out);
    case NumberType::kInt16:
      return copy_as<std::int16_t>(column, kept, out);
    case NumberType::kUint16:
      return copy_as<std::uint16_t>(column, kept, out);
    case NumberType::kInt32:
      return copy_as<std::int32_t>(column, kept, out);
    case NumberType::kUint32:
      return copy_as<std::uint32_t>(column, kept, out);
    case NumberType::kInt64:
      return copy_as<std::int64_t>(column, kept, out);
    case NumberType::kUint64:
      return copy_as<std::uint64_t>(column, kept, out);
    case NumberType::kFloat32:
      return copy_as<float>(column, kept, out);
    case NumberType::kFloat64:
      return copy_as<double>(column, kept, out);
  }
}

template <class Out>
std::vector<Out> kept_values(const Column& column, std::span<const std::uint32_t> kept) {
  std::vector<Out> values(kept.size());
  copy_column(column, kept, values.data());
  return values;
}

/// Rings of the kept rows; none where one of them is no ring: floats and wider numbers hold what 16 bits cannot.
std::vector<std::uint16_t> kept_rings(const Column& column, std::span<const std::uint32_t> kept) {
  const std::vector<double> values = kept_values<double>(column, kept);
  const bool sound = std::all_of(values.begin(), values.end(), [](double v) { return v >= 0.0 && v <= 65535.0; });
  return sound ? std::vector<std::uint16_t>(values.begin(), values.end()) : std::vector<std::uint16_t>();
}

/// Sorts out one point; true when it is kept.
bool usable(const Eigen::Vector3f& p, float max_range, DroppedPoints& dropped) {
  const float squared = p.squaredNorm();
  if (squared > 0.0F && squared <= max_range * max_range) {
    return true;
  }
  if (p.isZero(0.0F)) {
    ++dropped.no_return;
  } else if (!p.allFinite()) {
    ++dropped.not_finite;
  } else {
    const auto range_m = static_cast<double>(p.norm());
    dropped.nearest_absurd_m = dropped.absurd == 0 ? range_m : std::min(dropped.nearest_absurd_m, range_m);
    dropped.farthest_absurd_m = std::max(dropped.farthest_absurd_m, range_m);
    ++dropped.absurd;
  }
  return false;
}

template <class T>
void keep_usable(const PointColumns& columns, float max_range, PointFile& file, std::vector<std::uint32_t>& kept) {
  file.cloud.points.reserve(columns.count);
  kept.reserve(columns.count);
  for (std::size_t i = 0; i < columns.count; ++i) {
    std::array<T, 3> xyz;
    std::memcpy(&xyz[0], columns.x.data + i * columns.x.stride, sizeof(T));
    std::memcpy(&xyz[1], columns.y.data + i * columns.y.stride, sizeof(T));
    std::memcpy(&xyz[2], columns.z.data + i * columns.z.stride, sizeof(T));
    const Eigen::Vector3f point(static_cast<float>(xyz[0]), static_cast<float>(xyz[1]), static_cast<float>(xyz[2]));
    if (usable(point, max_range, file.dropped)) {
      file.cloud.points.push_back(point);
      kept.push_back(static_cast<std::uint32_t>(i));
    }
  }
}

/// Coordinates that are neither all float32 nor all float64 take a detour over a table of float64.
void keep_usable_mixed(const PointColumns& columns, float max_range, PointFile& file,
                       std::vector<std::uint32_t>& kept) {
  std::vector<std::uint32_t> all(columns.count);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = static_cast<std::uint32_t>(i);
  }
  const std::vector<double> x = kept_values<double>(columns.x, all);
  const std::vector<double> y = kept_values<double>(columns.y, all);
  const std::vector<double> z = kept_values<double>(columns.z, all);
  const auto column = [](const std::vector<double>& values) {
    return Column{reinterpret_cast<const char*>(values.data()), sizeof(double), NumberType::kFloat64};
  };
  PointColumns wide;
  wide.x = column(x);
  wide.y = column(y);
  wide.z = column(z);
  wide.count = columns.count;
  keep_usable<double>(wide, max_range, file, kept);
}

bool coordinates_are(const PointColumns& columns, NumberType type) {
  return columns.x.type == type && columns.y.type == type && columns.z.type == type;
}

/// Copies the usable points' coordinates; returns their rows.
std::vector<std::uint32_t> take_usable(const PointColumns& columns, const LogOptions& options, PointFile& file) {
  std::vector<std::uint32_t> kept;
  const auto max_range = static_cast<float>(options.max_range_m);
  if (coordinates_are(columns, NumberType::kFloat32)) {
    keep_usable<float>(columns, max_range, file, kept);
  } else if (coordinates_are(columns, NumberType::kFloat64)) {
    keep_usable<double>(columns, max_range, file, kept);
  } else {
    keep_usable_mixed(columns, max_range, file, kept);
  }
  return kept;
}

}  // namespace

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::kInt8:
    case NumberType::kUint8:
      return 1;
    case NumberType::kInt16:
    case NumberType::kUint16:
      return 2;
    case NumberType::kInt32:
    case NumberType::kUint32:
    case NumberType::kFloat32:
      return 4;
    default:
      return 8;
  }
}

Column* column_for_field(PointColumns& columns, std::string_view field_name) {
  const std::string name = text::lower_case(field_name);
  const auto is = [&name](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (is({"x"})) return &columns.x;
  if (is({"y"})) return &columns.y;
  if (is({"z"})) return &columns.z;
  if (is({"intensity", "i", "reflectivity", "scalar_intensity"})) return &columns.intensity;
  if (is({"ring", "laser_id", "channel", "line"})) return &columns.ring;
  if (is({"t", "time", "timestamp", "time_stamp", "offset_time"})) return &columns.time;
  return nullptr;
}

void require_coordinates(const PointColumns& columns, const std::string& file) {
  if (columns.x.empty() || columns.y.empty() || columns.z.empty()) {
    throw DamagedScan(file, "header", "the fields x, y and z are not all there");
  }
}

PointCloud filter_invalid(PointCloud cloud, const LogOptions& options, DroppedPoints& dropped) {
  std::vector<std::size_t> kept;
  kept.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (usable(cloud.points[i], static_cast<float>(options.max_range_m), dropped)) {
      kept.push_back(i);
    }
  }
  return kept.size() == cloud.size() ? std::move(cloud) : select(cloud, kept);
}

PointFile decode_points(const PointColumns& columns, const LogOptions& options, const TimeRule* rule) {
  PointFile file;
  const std::vector<std::uint32_t> kept = take_usable(columns, options, file);
  if (!columns.intensity.empty()) {
    file.cloud.intensity = kept_values<float>(columns.intensity, kept);
  }
  if (!columns.ring.empty()) {
    file.cloud.ring = kept_rings(columns.ring, kept);
  }
  if (!columns.time.empty()) {
    const bool fraction = columns.time.type == NumberType::kFloat32 || columns.time.type == NumberType::kFloat64;
    const std::vector<double> values = kept_values<double>(columns.time, kept);
    PointTimes times = rule != nullptr ? apply_time_rule(*rule, values) : interpret_times(values, fraction);
    file.cloud.time_offset_s = std::move(times.offset_s);
    file.first_time_s = times.first_s;
  }
  return file;
}

std::vector<double> times_of_usable_points(const PointColumns& columns, const LogOptions& options) {
  PointFile file;
  const std::vector<std::uint32_t> kept = take_usable(columns, options, file);
  return kept_values<double>(columns.time, kept);
}

}  // namespace loopmark::io::internal
