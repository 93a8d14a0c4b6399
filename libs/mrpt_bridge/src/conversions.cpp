// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mrpt_bridge/conversions.hpp"

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <algorithm>
#include <cmath>

#include "loopmark/core/error.hpp"

namespace loopmark::mrpt_bridge {
namespace {

using mrpt::maps::CPointsMapXYZI;
using mrpt::obs::CObservation;
using mrpt::obs::CObservationPointCloud;
using mrpt::obs::CObservationVelodyneScan;

/// d(x, y, z, yaw, pitch, roll) / d(xi) of exp(xi) * pose: the angles' rates turn about z, the yawed y and the yawed
/// and pitched x.
Matrix6d jacobian_of_mrpt_coordinates(const Pose& pose) {
  const Eigen::Vector3d rpy = euler_degrees(pose.linear()) * (M_PI / 180.0);
  const Eigen::Matrix3d yaw = Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d pitch = Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()).toRotationMatrix();
  Eigen::Matrix3d axes;
  axes.col(0) = Eigen::Vector3d::UnitZ();
  axes.col(1) = yaw * Eigen::Vector3d::UnitY();
  axes.col(2) = yaw * pitch * Eigen::Vector3d::UnitX();
  Matrix6d jacobian = Matrix6d::Identity();
  jacobian.topRightCorner<3, 3>() = -hat(pose.translation());
  jacobian.bottomRightCorner<3, 3>() = axes.inverse();
  return jacobian;
}

double seconds_between(mrpt::Clock::time_point from, mrpt::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

PointCloud from_velodyne(const CObservationVelodyneScan& observation) {
  CObservationVelodyneScan generated;
  const CObservationVelodyneScan::TPointCloud* points = &observation.point_cloud;
  if (!observation.scan_packets.empty() && (points->size() == 0 || points->timestamp.empty())) {
    generated = observation;
    CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
    parameters.generatePerPointTimestamp = true;
    generated.generatePointCloud(parameters);
    points = &generated.point_cloud;
  }
  PointCloud cloud;
  const std::size_t count = points->x.size();
  if (points->y.size() != count || points->z.size() != count) {
    throw std::runtime_error("the numbers of x, y and z coordinates differ");
  }
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.emplace_back(points->x[i], points->y[i], points->z[i]);
  }
  if (points->intensity.size() == count) {
    cloud.intensity.assign(points->intensity.begin(), points->intensity.end());
  }
  if (points->laser_id.size() == count) {
    cloud.ring.assign(points->laser_id.begin(), points->laser_id.end());
  }
  if (points->timestamp.size() == count) {
    for (const auto& stamp : points->timestamp) {
      cloud.time_offset_s.push_back(static_cast<float>(seconds_between(observation.timestamp, stamp)));
    }
  }
  return cloud;
}

PointCloud from_point_cloud(const CObservationPointCloud& observation) {
  try {
    observation.load();
  } catch (const std::exception& error) {
    throw InputError(observation.getExternalStorageFile(), "", std::string("cannot load the points: ") + error.what());
  }
  PointCloud cloud;
  if (!observation.pointcloud) {
    return cloud;
  }
  const mrpt::maps::CPointsMap& points = *observation.pointcloud;
  const auto& x = points.getPointsBufferRef_x();
  const auto& y = points.getPointsBufferRef_y();
  const auto& z = points.getPointsBufferRef_z();
  for (std::size_t i = 0; i < x.size(); ++i) {
    cloud.points.emplace_back(x[i], y[i], z[i]);
  }
  if (const auto* with_intensity = dynamic_cast<const CPointsMapXYZI*>(&points)) {
    const auto intensity = with_intensity->getPointsBufferRef_intensity();
    cloud.intensity.assign(intensity.begin(), intensity.end());
  }
  if (observation.isExternallyStored()) {
    observation.unload();
  }
  return cloud;
}

std::shared_ptr<CObservation> as_velodyne(const Scan& scan) {
  auto observation = std::make_shared<CObservationVelodyneScan>();
  observation->timestamp = mrpt::Clock::fromDouble(scan.stamp_s);
  const PointCloud& cloud = scan.cloud;
  auto& points = observation->point_cloud;
  const float brightest =
      cloud.intensity.empty() ? 0.0F : *std::max_element(cloud.intensity.begin(), cloud.intensity.end());
  const float scale = brightest <= 1.0F ? 255.0F : 1.0F;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points.x.push_back(cloud.points[i].x());
    points.y.push_back(cloud.points[i].y());
    points.z.push_back(cloud.points[i].z());
    const float intensity = cloud.intensity.empty() ? 0.0F : cloud.intensity[i] * scale;
    points.intensity.push_back(static_cast<std::uint8_t>(std::clamp(std::round(intensity), 0.0F, 255.0F)));
  }
  for (const float offset : cloud.time_offset_s) {
    points.timestamp.push_back(observation->timestamp + std::chrono::duration_cast<mrpt::Clock::duration>(
                                                            std::chrono::duration<double>(offset)));
  }
  points.laser_id.assign(cloud.ring.begin(), cloud.ring.end());
  return observation;
}

std::shared_ptr<CObservation> as_point_cloud(const Scan& scan) {
  auto observation = std::make_shared<CObservationPointCloud>();
  observation->timestamp = mrpt::Clock::fromDouble(scan.stamp_s);
  const auto points = CPointsMapXYZI::Create();
  points->reserve(scan.cloud.size());
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const Eigen::Vector3f& p = scan.cloud.points[i];
    points->insertPointFast(p.x(), p.y(), p.z());
    points->setPointIntensity(i, scan.cloud.intensity.empty() ? 0.0F : scan.cloud.intensity[i]);
  }
  observation->pointcloud = points;
  return observation;
}

}  // namespace

mrpt::poses::CPose3D to_mrpt(const Pose& pose) {
  return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(pose.matrix()));
}

Pose from_mrpt(const mrpt::poses::CPose3D& pose) {
  const mrpt::math::CMatrixDouble44 matrix = pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
  Pose converted = Pose::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      converted.matrix()(r, c) = matrix(r, c);
    }
  }
  return converted;
}

mrpt::poses::CPose3DPDFGaussian to_mrpt(const Pose& pose, const Matrix6d& covariance) {
  const Matrix6d jacobian = jacobian_of_mrpt_coordinates(pose);
  const Matrix6d converted = jacobian * covariance * jacobian.transpose();
  return {to_mrpt(pose), mrpt::math::CMatrixDouble66(converted)};
}

Matrix6d covariance_from_mrpt(const mrpt::poses::CPose3DPDFGaussian& pdf) {
  const Matrix6d inverse = jacobian_of_mrpt_coordinates(from_mrpt(pdf.mean)).inverse();
  Matrix6d covariance;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) {
      covariance(r, c) = pdf.cov(r, c);
    }
  }
  return inverse * covariance * inverse.transpose();
}

std::optional<PointCloud> cloud_from_observation(const CObservation& observation) {
  if (const auto* velodyne = dynamic_cast<const CObservationVelodyneScan*>(&observation)) {
    return from_velodyne(*velodyne);
  }
  if (const auto* points = dynamic_cast<const CObservationPointCloud*>(&observation)) {
    return from_point_cloud(*points);
  }
  return std::nullopt;
}

std::optional<Scan> scan_from_sensory_frame(const mrpt::obs::CSensoryFrame& frame, const std::string& sensor_label) {
  for (const auto& observation : frame) {
    if (!sensor_label.empty() && observation->sensorLabel != sensor_label) {
      continue;
    }
    if (std::optional<PointCloud> cloud = cloud_from_observation(*observation)) {
      return Scan{0, mrpt::Clock::toDouble(observation->timestamp), std::move(*cloud)};
    }
  }
  return std::nullopt;
}

std::shared_ptr<CObservation> observation_from_scan(const Scan& scan, const std::string& sensor_label) {
  const bool detailed = !scan.cloud.time_offset_s.empty() || !scan.cloud.ring.empty();
  auto observation = detailed ? as_velodyne(scan) : as_point_cloud(scan);
  observation->sensorLabel = sensor_label;
  return observation;
}

}  // namespace loopmark::mrpt_bridge
