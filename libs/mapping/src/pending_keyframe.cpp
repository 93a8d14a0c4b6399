// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pending_keyframe.hpp"

#include "loopmark/storage/byte_stream.hpp"

namespace loopmark::mapping::internal {

std::string to_bytes(const PendingKeyframe& pending) {
  storage::ByteWriter writer;
  writer.text(to_line(pending.record));
  writer.value(pending.scan.index);
  writer.value(pending.scan.stamp_s);
  writer.points(pending.scan.cloud.points);
  writer.vector(pending.scan.cloud.intensity);
  writer.vector(pending.scan.cloud.time_offset_s);
  writer.vector(pending.scan.cloud.ring);
  return storage::sealed(writer.bytes());
}

PendingKeyframe pending_from_bytes(const std::string& bytes) {
  const std::string content = storage::unsealed(bytes, "the keyframe that an interrupted run held back");
  storage::ByteReader reader(content);
  PendingKeyframe pending;
  pending.record = map_store::scan_from_line(reader.text());
  pending.scan.index = reader.value<std::size_t>();
  pending.scan.stamp_s = reader.value<double>();
  pending.scan.cloud.points = reader.points();
  pending.scan.cloud.intensity = reader.vector<float>();
  pending.scan.cloud.time_offset_s = reader.vector<float>();
  pending.scan.cloud.ring = reader.vector<std::uint16_t>();
  return pending;
}

}  // namespace loopmark::mapping::internal
