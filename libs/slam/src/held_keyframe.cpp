// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "held_keyframe.hpp"

#include "loopmark/core/byte_stream.hpp"

namespace loopmark {

std::string to_bytes(const HeldKeyframe& held) {
  ByteWriter writer;
  writer.text(to_line(held.record));
  writer.value(held.scan.index);
  writer.value(held.scan.stamp_s);
  writer.points(held.scan.cloud.points);
  writer.vector(held.scan.cloud.intensity);
  writer.vector(held.scan.cloud.time_offset_s);
  writer.vector(held.scan.cloud.ring);
  return sealed(writer.bytes());
}

HeldKeyframe held_from_bytes(const std::string& bytes) {
  const std::string content = unsealed(bytes, "the keyframe that an interrupted run held back");
  ByteReader reader(content);
  HeldKeyframe held;
  held.record = scan_from_line(reader.text());
  held.scan.index = reader.value<std::size_t>();
  held.scan.stamp_s = reader.value<double>();
  held.scan.cloud.points = reader.points();
  held.scan.cloud.intensity = reader.vector<float>();
  held.scan.cloud.time_offset_s = reader.vector<float>();
  held.scan.cloud.ring = reader.vector<std::uint16_t>();
  return held;
}

}  // namespace loopmark
