// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// sensor_msgs/PointCloud2: points with named fields of any type and place.
#include <algorithm>
#include <array>
#include <cmath>

#include "cloud_message.hpp"
#include "loopmark/messages/types.hpp"
#include "point_columns.hpp"
#include "time_rule.hpp"

namespace loopmark::io::internal {
namespace {

using messages::PointCloud2;
using messages::PointField;

constexpr std::array kTypes = {NumberType::kInt8,  NumberType::kUint8,  NumberType::kInt16,   NumberType::kUint16,
                               NumberType::kInt32, NumberType::kUint32, NumberType::kFloat32, NumberType::kFloat64};

/// The points one behind the other: the message's own bytes, or a copy without the padding of its rows.
std::string_view packed_points(const messages::PointCloud2& m, std::string& copy) {
  const std::uint64_t row = std::uint64_t{m.width} * m.point_step;
  const std::uint64_t stride = m.height > 1 ? m.row_step : row;
  if (m.height == 0 || m.width == 0) {
    return {};
  }
  if (stride < row || (m.height - 1) * stride + row > m.data.size()) {
    throw InputError("a cloud of " + std::to_string(m.width) + " x " + std::to_string(m.height) + " points of " +
                     std::to_string(m.point_step) + " bytes with only " + std::to_string(m.data.size()) +
                     " bytes of data");
  }
  if (stride == row) {
    return m.data.substr(0, m.height * row);
  }
  copy.clear();
  for (std::uint64_t r = 0; r < m.height; ++r) {
    copy += m.data.substr(r * stride, row);
  }
  return copy;
}

/// The columns of the fields that are known. Fields that do not fit into a point are an error.
PointColumns columns_of(const messages::PointCloud2& m, std::string_view data) {
  PointColumns columns;
  columns.count = m.point_step == 0 ? 0 : data.size() / m.point_step;
  for (const messages::PointField& field : m.point_fields) {
    if (field.datatype < 1 || field.datatype > kTypes.size()) {
      continue;  // of a type that PointField does not know; the fields that are needed are missed below
    }
    const NumberType type = kTypes[field.datatype - 1U];
    if (std::uint64_t{field.offset} + size_of(type) > m.point_step) {
      throw InputError("field '" + field.name + "' lies behind the end of a point of " + std::to_string(m.point_step) +
                       " bytes");
    }
    Column* column = column_for_field(columns, field.name);
    if (column != nullptr && column->empty()) {
      *column = {data.data() + field.offset, m.point_step, type};
    }
  }
  return columns;
}

messages::PointCloud2 understood(messages::Encoding encoding, std::string_view bytes) {
  auto m = messages::decode<messages::PointCloud2>(encoding, bytes);
  if (m.big_endian) {
    throw InputError("the cloud's numbers are big-endian, which is not read");
  }
  return m;
}

std::string time_field_of(const messages::PointCloud2& m) {
  for (const messages::PointField& field : m.point_fields) {
    PointColumns probe;
    if (column_for_field(probe, field.name) == &probe.time) {
      return field.name;
    }
  }
  return "";
}

class PointCloud2Decoder : public CloudDecoder {
 public:
  PointCloud2Decoder(const MessageSamples& samples, const LogOptions& options)
      : encoding_(samples.channel.encoding), options_(options) {
    std::vector<TimeSpan> sweeps;
    bool fraction = false;
    std::string problem;
    for (const std::string& bytes : samples.messages) {
      try {
        learn(understood(encoding_, bytes), sweeps, fraction);
      } catch (const InputError& error) {
        problem = error.what();  // a damaged message is met again when it is read
      }
    }
    if (fields_.empty() && !problem.empty()) {
      throw InputError(problem);
    }
    rule_ = find_time_rule(sweeps, fraction);
  }

  PointFile decode(std::string_view message) const override {
    const messages::PointCloud2 m = understood(encoding_, message);
    std::string copy;
    const std::string_view data = packed_points(m, copy);
    const PointColumns columns = columns_of(m, data);
    if (columns.count == 0) {
      return {};
    }
    require_fields(columns);
    return decode_points(columns, options_, &rule_);
  }

  std::string describe() const override {
    return "fields " + fields_ + (time_field_.empty() ? "" : "; times: " + rule_.describe(time_field_));
  }
  std::string frame_id() const override { return frame_id_; }

 private:
  static void require_fields(const PointColumns& columns) {
    if (columns.x.empty() || columns.y.empty() || columns.z.empty()) {
      throw InputError("the fields x, y and z are not all there");
    }
  }

  void learn(const messages::PointCloud2& m, std::vector<TimeSpan>& sweeps, bool& fraction) {
    std::string copy;
    const std::string_view data = packed_points(m, copy);
    const PointColumns columns = columns_of(m, data);
    if (fields_.empty()) {
      for (const messages::PointField& field : m.point_fields) {
        fields_ += (fields_.empty() ? "" : " ") + field.name;
      }
      frame_id_ = m.header.frame_id;
      time_field_ = time_field_of(m);
    }
    if (columns.time.empty() || columns.count == 0) {
      return;
    }
    require_fields(columns);
    fraction = columns.time.type == NumberType::kFloat32 || columns.time.type == NumberType::kFloat64;
    const std::vector<double> values = times_of_usable_points(columns, options_);
    const auto finite = [](double v) { return std::isfinite(v); };
    if (!values.empty() && std::all_of(values.begin(), values.end(), finite)) {
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      sweeps.push_back({*least, *most});
    }
  }

  messages::Encoding encoding_;
  LogOptions options_;
  TimeRule rule_;
  std::string fields_, time_field_, frame_id_;
};

}  // namespace

CloudMessage message_pointcloud2() {
  return {"sensor_msgs/PointCloud2", 2, [](const MessageSamples& samples, const LogOptions& options) {
            return std::make_unique<PointCloud2Decoder>(samples, options);
          }};
}

}  // namespace loopmark::io::internal
