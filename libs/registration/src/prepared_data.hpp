// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a PreparedScan holds.
#pragma once

#include <atomic>
#include <memory>

#include "loopmark/bev/ground_map.hpp"
#include "loopmark/bev/landmarks.hpp"
#include "loopmark/bev/structure.hpp"
#include "loopmark/registration/engine.hpp"
#include "loopmark/registration/range_image.hpp"
#include "loopmark/shape_context/fourier_shape_context.hpp"
#include "loopmark/surfels/surfel_map.hpp"

namespace loopmark::registration {

/// One viewpoint: where its sensor stood and what its beams saw.
struct View {
  Pose T_level_sensor = Pose::Identity();
  RangeImage image;
};

/// Descriptors of a scan, made when they are first asked for: they follow from the surfels and are not stored. Threads
/// that ask at the same time may make them twice and get the same; one that waited for another within a parallel loop
/// could wait for itself.
class LazyKeypoints {
 public:
  std::shared_ptr<const shape_context::Keypoints> of(const surfels::SurfelMap& fine) const;

 private:
  struct Place {
    std::atomic<std::shared_ptr<const shape_context::Keypoints>> made;
  };
  std::shared_ptr<Place> place_ = std::make_shared<Place>();
};

struct PreparedScan::Data {
  Pose T_level_sensor = Pose::Identity();  ///< of the scan, or of the submap's frame
  double ground_share = 0.0;               ///< share of the near points on the ground plane; 0: none found
  surfels::SurfelMap fine;                 ///< 0.4 m
  surfels::SurfelMap coarse;               ///< 1.2 m
  bev::BirdseyeView above;                 ///< for the bird's-eye-view correlation
  std::vector<bev::Landmark> landmarks;
  bev::GroundMap ground;
  std::vector<View> views;
  LazyKeypoints keypoints;
};

constexpr float kFineSurfel = 0.4F;
constexpr int kCoarseFactor = 3;
constexpr float kMeanStep = 0.005F;           ///< metres: means are kept in these steps, so that stored scans are exact
constexpr float kNormalStep = 1.0F / 127.0F;  ///< of normals and planarity
constexpr float kStructureHeight = 0.5F;      ///< surfels higher above the ground than this are structure, metres
constexpr float kGroundHeight = 0.3F;         ///< surfels lower than this are ground, metres

/// Fills what follows from the surfels: the maps, the ground, what is seen from above.
void derive(PreparedScan::Data& data, std::vector<surfels::Surfel> surfels);

}  // namespace loopmark::registration
