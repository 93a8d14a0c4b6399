// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>

#include "gz_stream.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/mrpt_bridge/conversions.hpp"
#include "loopmark/mrpt_bridge/map_export.hpp"

namespace loopmark::mrpt_bridge {
namespace fs = std::filesystem;
namespace {

const char* const kKeyframeLabel = "keyframe";

/// Serialises as a CSimpleMap whose keyframes are made while it is written.
class StreamedSimpleMap : public mrpt::serialization::CSerializable {
 public:
  StreamedSimpleMap(std::size_t count, const std::function<SimpleMapKeyframe(std::size_t)>& keyframe)
      : count_(count), keyframe_(keyframe) {}

  const mrpt::rtti::TRuntimeClassId* GetRuntimeClass() const override { return CLASS_ID(mrpt::maps::CSimpleMap); }
  mrpt::rtti::CObject* clone() const override { return new StreamedSimpleMap(*this); }

 protected:
  std::uint8_t serializeGetVersion() const override { return 1; }

  void serializeTo(mrpt::serialization::CArchive& out) const override {
    out.WriteAs<std::uint32_t>(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const SimpleMapKeyframe keyframe = keyframe_(i);
      mrpt::obs::CSensoryFrame frame;
      frame.insert(observation_from_scan(keyframe.scan, kKeyframeLabel));
      out << to_mrpt(keyframe.T_map_keyframe, keyframe.covariance) << frame;
    }
  }

  void serializeFrom(mrpt::serialization::CArchive&, std::uint8_t) override {
    throw std::logic_error("read with mrpt::maps::CSimpleMap");
  }

 private:
  std::size_t count_;
  const std::function<SimpleMapKeyframe(std::size_t)>& keyframe_;
};

/// Calls save(temporary name), then gives the file its name. Throws InputError when either fails.
void save_under_temporary_name(const fs::path& path, const std::function<bool(const std::string&)>& save) {
  const fs::path partial = path.string() + ".partial";
  std::error_code error;
  bool done = false;
  try {
    done = save(partial.string());
  } catch (const InputError&) {
    fs::remove(partial, error);
    throw;
  } catch (const std::exception&) {
    done = false;
  }
  if (done) {
    fs::rename(partial, path, error);
  }
  if (!done || error) {
    fs::remove(partial, error);
    throw InputError(path.string(), "", "cannot write", "is the disk full, and may you write there?");
  }
}

mrpt::opengl::CSetOfLines::Ptr lines_of(const SceneContent& content) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName("trajectory");
  lines->setColor(0.1F, 0.3F, 0.9F);
  lines->setLineWidth(3.0F);
  for (std::size_t i = 1; i < content.trajectory.size(); ++i) {
    const Eigen::Vector3d a = content.trajectory[i - 1].translation();
    const Eigen::Vector3d b = content.trajectory[i].translation();
    lines->appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  }
  return lines;
}

mrpt::opengl::CSetOfLines::Ptr loops_of(const SceneContent& content) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName("loop closures");
  lines->setColor(0.9F, 0.3F, 0.1F);
  lines->setLineWidth(2.0F);
  for (const auto& [from, to] : content.loops) {
    const Eigen::Vector3d a = content.trajectory.at(from).translation();
    const Eigen::Vector3d b = content.trajectory.at(to).translation();
    lines->appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  }
  return lines;
}

mrpt::opengl::CPointCloudColoured::Ptr points_of(const SceneContent& content) {
  auto cloud = mrpt::opengl::CPointCloudColoured::Create();
  cloud->setName("points");
  cloud->setPointSize(2.0F);
  cloud->reserve(content.points.size());
  for (std::size_t i = 0; i < content.points.size(); ++i) {
    const Eigen::Vector3f& p = content.points[i];
    const auto colour = content.colours.empty() ? std::array<std::uint8_t, 3>{160, 160, 160} : content.colours.at(i);
    cloud->push_back(p.x(), p.y(), p.z(), static_cast<float>(colour[0]) / 255.0F,
                     static_cast<float>(colour[1]) / 255.0F, static_cast<float>(colour[2]) / 255.0F);
  }
  return cloud;
}

mrpt::opengl::CGridPlaneXY::Ptr grid_below(const SceneContent& content) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(-20.0);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(20.0);
  for (const Pose& pose : content.trajectory) {
    low = low.cwiseMin(pose.translation() - Eigen::Vector3d::Constant(20.0));
    high = high.cwiseMax(pose.translation() + Eigen::Vector3d::Constant(20.0));
  }
  const auto round_to_grid = [](double value) { return static_cast<float>(10.0 * std::round(value / 10.0)); };
  auto grid = mrpt::opengl::CGridPlaneXY::Create(round_to_grid(low.x()), round_to_grid(high.x()),
                                                 round_to_grid(low.y()), round_to_grid(high.y()), 0.0F, 10.0F);
  grid->setColor(0.7F, 0.7F, 0.7F);
  return grid;
}

}  // namespace

void write_simplemap(const fs::path& path, std::size_t count,
                     const std::function<SimpleMapKeyframe(std::size_t)>& keyframe) {
  save_under_temporary_name(path, [&](const std::string& name) {
    internal::GzOutput file(name);
    mrpt::serialization::archiveFrom(file) << StreamedSimpleMap(count, keyframe);
    file.close();
    return true;
  });
}

std::vector<SimpleMapKeyframe> read_simplemap(const fs::path& path) {
  mrpt::maps::CSimpleMap map;
  bool read = false;
  try {
    read = map.loadFromFile(path.string());
  } catch (const std::exception&) {
    read = false;
  }
  if (!read) {
    throw InputError(path.string(), "", "not a .simplemap that can be read");
  }
  std::vector<SimpleMapKeyframe> keyframes;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto [pdf, frame] = map.get(i);
    mrpt::poses::CPose3DPDFGaussian gaussian;
    gaussian.copyFrom(*pdf);
    keyframes.push_back(
        {from_mrpt(gaussian.mean), covariance_from_mrpt(gaussian), scan_from_sensory_frame(*frame).value_or(Scan{})});
    keyframes.back().scan.index = i;
  }
  return keyframes;
}

void write_scene(const fs::path& path, const SceneContent& content) {
  mrpt::opengl::COpenGLScene scene;
  scene.insert(grid_below(content));
  scene.insert(points_of(content));
  scene.insert(lines_of(content));
  scene.insert(loops_of(content));
  save_under_temporary_name(path, [&](const std::string& name) { return scene.saveToFile(name); });
}

}  // namespace loopmark::mrpt_bridge
