// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/odometry.hpp"
#include "loopmark/storage/byte_stream.hpp"

namespace loopmark::odometry {
namespace {

void write_pose(storage::ByteWriter& writer, const Pose& pose) { writer.raw(pose.matrix().data(), 16); }

Pose read_pose(storage::ByteReader& reader) {
  Pose pose;
  reader.raw(pose.matrix().data(), 16);
  return pose;
}

constexpr std::uint64_t kFormat = 0x6f646f6d65747234;  // "odometr4": changes with what is written

void write_directions(storage::ByteWriter& writer, const std::vector<Eigen::Vector3d>& directions) {
  writer.value(directions.size());
  for (const Eigen::Vector3d& direction : directions) {
    writer.raw(direction.data(), 3);
  }
}

std::vector<Eigen::Vector3d> read_directions(storage::ByteReader& reader) {
  std::vector<Eigen::Vector3d> directions;
  for (auto left = reader.value<std::size_t>(); left > 0; --left) {
    reader.raw(directions.emplace_back().data(), 3);
  }
  return directions;
}

}  // namespace

std::string Odometry::state() const {
  storage::ByteWriter writer;
  writer.value(kFormat);
  write_pose(writer, origin_);
  writer.value(committed_);
  writer.value(last_gap_s_);
  writer.vector(std::vector<double>(deviations_.begin(), deviations_.end()));
  writer.raw(swept_at_.data(), 3);
  writer.value(last_.has_value());
  if (last_) {
    writer.value(last_->index);
    writer.value(last_->stamp_s);
    write_pose(writer, last_->T_map_lidar);
    writer.raw(last_->velocity.data(), 6);
    writer.raw(last_->sweep_velocity.data(), 6);
    write_directions(writer, last_->tracking_status.degenerate_directions);
    writer.points(last_->sample.points);
    writer.vector(last_->sample.time_offset_s);
    writer.text(map_->to_bytes());
    writer.text(coarse_->to_bytes());
  }
  return storage::sealed(writer.bytes());
}

void Odometry::set_state(const std::string& bytes) {
  const std::string content = storage::unsealed(bytes, "the saved state of the odometry");
  storage::ByteReader reader(content);
  if (reader.value<std::uint64_t>() != kFormat) {
    throw InputError("the saved state of the odometry is of another version of loopmark: map the log anew");
  }
  restart(read_pose(reader));
  committed_ = reader.value<std::size_t>();
  last_gap_s_ = reader.value<double>();
  const auto deviations = reader.vector<double>();
  deviations_.assign(deviations.begin(), deviations.end());
  reader.raw(swept_at_.data(), 3);
  if (reader.value<bool>()) {
    TrackedScan& last = last_.emplace();
    last.index = reader.value<std::size_t>();
    last.stamp_s = reader.value<double>();
    last.T_map_lidar = read_pose(reader);
    reader.raw(last.velocity.data(), 6);
    reader.raw(last.sweep_velocity.data(), 6);
    last.tracking_status.degenerate_directions = read_directions(reader);
    last.sample.points = reader.points();
    last.sample.time_offset_s = reader.vector<float>();
    map_ = surfels::LocalMap::from_bytes(reader.text());
    coarse_ = surfels::LocalMap::from_bytes(reader.text());
  }
}

}  // namespace loopmark::odometry
