// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pair_sets/reference_refinement.hpp"

#include <algorithm>
#include <map>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/refinement/icp.hpp"
#include "loopmark/statistics/statistics.hpp"

namespace loopmark::pair_sets {
namespace {

constexpr double kVoxelM = 0.3;
constexpr double kMostShiftM = 1.0;
constexpr double kMostTurnDeg = 2.0;

/// Where the scans of a frame number are.
class FrameIndex {
 public:
  explicit FrameIndex(const std::vector<Drive>& drives) {
    for (const Drive& drive : drives) {
      for (std::size_t place = 0; place < drive.size(); ++place) {
        places_[{drive.session, drive.frames[place]}] = {&drive, place};
      }
    }
  }
  PointCloud load(int session, int frame) const {
    const auto& [drive, place] = places_.at({session, frame});
    return drive->load(place);
  }

 private:
  std::map<std::pair<int, int>, std::pair<const Drive*, std::size_t>> places_;
};

/// Refines one pair; returns how far it moved (m), or -1 when it stays.
double refine(RegistrationPair& pair, const FrameIndex& index, ReferenceRefinement how) {
  const PointCloud source = index.load(pair.key.session, pair.key.source);
  const PointCloud target = index.load(pair.key.target_session, pair.key.target);
  const refinement::IcpOptions options;
  const refinement::IcpTarget small_target({cloud::voxel_downsampled(target, kVoxelM).points, {}},
                                           options.max_distance_m);
  const refinement::IcpResult result = refinement::icp({cloud::voxel_downsampled(source, kVoxelM).points, {}},
                                                       small_target, pair.T_target_source, options);
  Pose refined = result.T_target_source;
  if (how == ReferenceRefinement::kHeight) {
    refined = pair.T_target_source;
    refined.translation().z() = result.T_target_source.translation().z();
  }
  const PoseError shift = pose_error(refined, pair.T_target_source);
  if (result.stop == refinement::IcpStop::kTooFewPairs || shift.translation_m > kMostShiftM ||
      shift.rotation_deg > kMostTurnDeg) {
    return -1.0;
  }
  const cloud::Overlap again = cloud::overlap(source, target, refined);
  pair = make_pair(pair.key, refined, again.source, again.symmetric);
  return shift.translation_m;
}

}  // namespace

RefinementReport refine_references(std::vector<RegistrationPair>& pairs, const std::vector<Drive>& drives,
                                   ReferenceRefinement how) {
  RefinementReport report;
  if (how == ReferenceRefinement::kNone) {
    return report;
  }
  const FrameIndex index(drives);
  std::vector<double> shifts(pairs.size());
  parallel_for(pairs.size(), [&](std::size_t i) {
    check_interrupt();
    shifts[i] = refine(pairs[i], index, how);
  });
  std::erase_if(shifts, [](double shift) { return shift < 0.0; });
  report.refined = shifts.size();
  report.kept = pairs.size() - shifts.size();
  report.median_shift_m = statistics::quantile(shifts, 0.5);
  return report;
}

}  // namespace loopmark::pair_sets
