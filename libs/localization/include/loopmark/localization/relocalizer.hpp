// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Finds the sensor in a map with no hint, tracks it there, and notices when it is lost.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "loopmark/localization/place_beliefs.hpp"
#include "loopmark/odometry/odometry.hpp"

namespace loopmark::localization {

struct Followed;
namespace internal {
struct PlaceComparison;
}  // namespace internal

/// The map as a relocalizer sees it. Calls may come from several threads; answers must not depend on what was asked
/// before.
class PlaceMap {
 public:
  virtual ~PlaceMap() = default;

  /// Registers a scan (deskewed points, sensor's frame) to the `places` of the map that look like it most, and to those
  /// where it is `believed` to be: every distinct answer once, the most probable first, with its log-odds among all
  /// places of the map.
  virtual std::vector<LocalizationHypothesis> search(const PointCloud& scan, std::size_t places,
                                                     const std::vector<Pose>& priors) const = 0;

  /// What registration says of the poses that are `believed`, each by itself, whatever else the map holds.
  virtual std::vector<LocalizationHypothesis> judge(const PointCloud& scan, const std::vector<Pose>& priors) const = 0;

  /// The map's points within `radius` of a position, map frame.
  virtual std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& position, double radius) const = 0;
};

enum class RelocalizationState {
  kSearching,  ///< the place is not known yet
  kTracking,   ///< the pose follows the map
  kLost        ///< the place was known until this scan, which does not fit any more
};
const char* name(RelocalizationState state);

struct RelocalizedScan {
  std::size_t scan = 0;
  double stamp_s = 0.0;
  RelocalizationState state = RelocalizationState::kSearching;
  bool given_up = false;  ///< the place that was known until this scan does not hold; `state` says what came of it
  bool answered = false;  ///< T_map_lidar is given
  Pose T_map_lidar = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of xi in exp(xi) * T_map_lidar
  double p_correct = 0.0;                      ///< of the place, over all candidates and "none of these"
  double inlier_share = 0.0;                   ///< while tracking: keypoints that fit the map
  std::string reason;                          ///< why there is no answer, or why the place was lost
};

/// Finds the sensor in a map and follows it there; fed scan by scan.
///
///   Relocalizer relocalizer(open_place_map(...), {});
///   const RelocalizedScan where = relocalizer.add(scan);   // where.state, where.T_map_lidar if where.answered
class Relocalizer {
 public:
  Relocalizer(std::shared_ptr<const PlaceMap> map, const RelocalizationOptions& options,
              const odometry::OdometryOptions& odometry_options = {},
              odometry::Compensation compensation = odometry::Compensation::kCompensated,
              const cloud::SweepModel& sweep = {});
  ~Relocalizer();

  /// The next scan, in the order of their stamps.
  RelocalizedScan add(const Scan& scan);

  /// Where the next scan stands, told from outside: tracking begins there without a search, and is given up like any
  /// other when scans do not fit.
  void place(const Pose& T_map_lidar);

 private:
  struct State;
  odometry::TrackedScan follow_odometry(const Scan& scan, RelocalizedScan& answer);
  void search(const Scan& scan, odometry::TrackedScan tracked, RelocalizedScan& answer);
  Vector6d correct_first_scan(const Scan& scan, const odometry::TrackedScan& tracked,
                              std::vector<LocalizationHypothesis>& answers);
  void judge_again(const PointCloud& cloud, const Pose& best, std::vector<LocalizationHypothesis>& answers) const;
  void begin_tracking(const Pose& T_map_odometry, const Pose& T_odometry_lidar, double log_odds);
  void track(const Scan& scan, const odometry::TrackedScan& tracked, bool just_found, RelocalizedScan& answer);
  void examine(const PointCloud& cloud, const odometry::TrackedScan& tracked, bool just_found, Followed& followed);
  Pose verified(const PointCloud& cloud, const odometry::TrackedScan& tracked, const Pose& T_map_lidar);
  internal::PlaceComparison compared(const PointCloud& cloud, const odometry::TrackedScan& tracked, Pose& T_map_lidar);
  Pose settled(const odometry::TrackedScan& tracked, const Pose& T_map_lidar, const Pose& better);
  void lose(const std::string& reason, RelocalizedScan& answer);

  std::unique_ptr<State> state_;
};

}  // namespace loopmark::localization
