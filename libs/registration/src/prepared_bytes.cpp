// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Storage of prepared scans: "LMPS", version, CRC-32 of the rest, then the fields, little-endian.
#include <cmath>
#include <cstring>
#include <type_traits>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "prepared_data.hpp"

namespace loopmark::registration {
namespace {

constexpr char kMagic[4] = {'L', 'M', 'P', 'S'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeader = 12;
constexpr std::size_t kMostViews = 1024;  // of a submap; each holds an image, however few bytes stand for it
constexpr double kFarthest_m = 1e6;
constexpr double kNotRigid = 1e-3;

template <class T>
void put(std::string& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

[[noreturn]] void damaged(const std::string& problem) {
  throw InputError("prepared scan", "", problem, "prepare the scan again");
}

/// Takes fields from the front of the bytes.
class Reader {
 public:
  Reader(const std::string& bytes, std::size_t offset) : bytes_(bytes), offset_(offset) {}

  template <class T>
  T take() {
    if (offset_ + sizeof(T) > bytes_.size()) {
      damaged("the bytes end early");
    }
    T value;
    std::memcpy(&value, bytes_.data() + offset_, sizeof value);
    offset_ += sizeof value;
    return value;
  }

  /// A count of items that take at least `item_bytes` each.
  std::size_t count(std::size_t item_bytes) {
    const auto n = take<std::uint32_t>();
    if (n * item_bytes > bytes_.size() - offset_) {
      damaged("a count is larger than what follows");
    }
    return n;
  }

 private:
  const std::string& bytes_;
  std::size_t offset_;
};

void put_pose(std::string& bytes, const Pose& pose) {
  for (int i = 0; i < 12; ++i) {
    put(bytes, pose.matrix()(i / 4, i % 4));
  }
}

Pose take_pose(Reader& reader) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < 12; ++i) {
    pose.matrix()(i / 4, i % 4) = reader.take<double>();
  }
  const Eigen::Matrix3d R = pose.linear();
  if (!pose.matrix().allFinite() || pose.translation().norm() > kFarthest_m ||
      (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kNotRigid) {
    damaged("a pose is none");
  }
  return pose;
}

template <class Integer>
Integer steps(float value, float step) {
  return static_cast<Integer>(std::lround(value / step));
}

void put_surfel(std::string& bytes, const surfels::Surfel& surfel) {
  for (int axis = 0; axis < 3; ++axis) {
    put(bytes, steps<std::int16_t>(surfel.mean[axis], kMeanStep));
  }
  for (int axis = 0; axis < 3; ++axis) {
    put(bytes, steps<std::int8_t>(surfel.normal[axis], kNormalStep));
  }
  put(bytes, steps<std::int8_t>(surfel.planarity, kNormalStep));
}

surfels::Surfel take_surfel(Reader& reader) {
  surfels::Surfel surfel;
  for (int axis = 0; axis < 3; ++axis) {
    surfel.mean[axis] = static_cast<float>(reader.take<std::int16_t>()) * kMeanStep;
  }
  for (int axis = 0; axis < 3; ++axis) {
    surfel.normal[axis] = static_cast<float>(reader.take<std::int8_t>()) * kNormalStep;
  }
  surfel.planarity = static_cast<float>(reader.take<std::int8_t>()) * kNormalStep;
  return surfel;
}

/// Runs of empty cells are stored as their length.
void put_image(std::string& bytes, const RangeImage& image) {
  const auto& cells = image.cells();
  for (std::size_t i = 0; i < cells.size();) {
    std::size_t empty = 0;
    while (i + empty < cells.size() && cells[i + empty].nearest == 0) {
      ++empty;
    }
    i += empty;
    std::size_t full = 0;
    while (i + full < cells.size() && cells[i + full].nearest != 0) {
      ++full;
    }
    put(bytes, static_cast<std::uint16_t>(empty));
    put(bytes, static_cast<std::uint16_t>(full));
    for (std::size_t end = i + full; i < end; ++i) {
      put(bytes, cells[i].nearest);
      put(bytes, cells[i].farthest);
    }
  }
}

RangeImage take_image(Reader& reader) {
  std::vector<RangeImage::Cell> cells(RangeImage::kColumns * RangeImage::kRows);
  for (std::size_t i = 0; i < cells.size();) {
    i += reader.take<std::uint16_t>();
    const std::size_t full = reader.take<std::uint16_t>();
    if (i + full > cells.size()) {
      damaged("a range image is too long");
    }
    for (std::size_t end = i + full; i < end; ++i) {
      cells[i].nearest = reader.take<std::uint16_t>();
      cells[i].farthest = reader.take<std::uint16_t>();
    }
  }
  return RangeImage(std::move(cells));
}

}  // namespace

std::string PreparedScan::to_bytes() const {
  std::string body;
  put_pose(body, data_->T_level_sensor);
  put(body, data_->ground_share);
  put(body, static_cast<std::uint32_t>(data_->fine.surfels().size()));
  for (const surfels::Surfel& surfel : data_->fine.surfels()) {
    put_surfel(body, surfel);
  }
  put(body, static_cast<std::uint32_t>(data_->views.size()));
  for (const View& view : data_->views) {
    put_pose(body, view.T_level_sensor);
    put_image(body, view.image);
  }
  std::string bytes(kMagic, sizeof kMagic);
  put(bytes, kVersion);
  put(bytes, storage::crc32(body));
  return bytes + body;
}

PreparedScan PreparedScan::from_bytes(const std::string& bytes) {
  if (bytes.size() < kHeader || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    damaged("these are not the bytes of a prepared scan");
  }
  Reader reader(bytes, sizeof kMagic);
  if (reader.take<std::uint32_t>() != kVersion) {
    damaged("another version wrote it");
  }
  if (reader.take<std::uint32_t>() != storage::crc32(std::string_view(bytes).substr(kHeader))) {
    damaged("the checksum is wrong");
  }
  Data data;
  data.T_level_sensor = take_pose(reader);
  data.ground_share = reader.take<double>();
  if (!(data.ground_share >= 0.0 && data.ground_share <= 1.0)) {
    damaged("the share of ground is not within 0 and 1");
  }
  std::vector<surfels::Surfel> surfels(reader.count(10));
  for (surfels::Surfel& surfel : surfels) {
    surfel = take_surfel(reader);
  }
  const std::size_t views = reader.count(96);
  if (views > kMostViews) {
    damaged("more than " + std::to_string(kMostViews) + " views");
  }
  data.views.resize(views);
  for (View& view : data.views) {
    view.T_level_sensor = take_pose(reader);
    view.image = take_image(reader);
  }
  derive(data, std::move(surfels));
  return PreparedScan(std::make_shared<const Data>(std::move(data)));
}

}  // namespace loopmark::registration
