// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "loopmark/localization/relocalizer.hpp"
#include "loopmark/odometry/alignment.hpp"
#include "sweep_motion.hpp"

namespace loopmark::localization {

constexpr double kGapS = 0.3;           ///< a longer gap between two scans is a reason to verify
constexpr double kDisagreementM = 0.3;  ///< between map and own motion in one scan, or nearest points and registration

/// A scan while the place is known.
struct Followed {
  Pose predicted = Pose::Identity();    ///< T_map_lidar by own motion
  Pose T_map_lidar = Pose::Identity();  ///< where it fits
  PoseError jump;                       ///< between the two as nearest points have it
  odometry::TrackingStatus tracking_status;
  bool fits = false;       ///< a pose can be given
  bool elsewhere = false;  ///< it is clear that the sensor is at another place
  std::string reason;      ///< why there is no pose, or why the place is given up
};

/// What a relocalizer remembers from scan to scan.
struct Relocalizer::State {
  State(std::shared_ptr<const PlaceMap> m, const RelocalizationOptions& o, const odometry::OdometryOptions& odometry_o,
        odometry::Compensation compensation, const cloud::SweepModel& sweep)
      : map(std::move(m)),
        options(o),
        odometry_options(odometry_o),
        odometry(odometry_o, compensation, sweep),
        beliefs(o) {}

  std::shared_ptr<const PlaceMap> map;
  RelocalizationOptions options;
  odometry::OdometryOptions odometry_options;
  odometry::Odometry odometry;
  std::optional<odometry::TrackedScan>
      first_with_motion;      ///< the scan before, if it was the first one and the map told its motion
  std::size_t committed = 0;  ///< scans since the motion began or was lost
  std::optional<double> last_stamp_s;
  double gap_s = 0.0;  ///< before this scan
  std::optional<Pose> prior;

  PlaceBeliefs beliefs;             ///< while searching
  std::optional<Pose> searched_at;  ///< T_odometry_lidar of the scan that was registered last

  bool tracking = false;
  Pose T_map_odometry = Pose::Identity();
  double log_odds = 0.0;
  std::size_t misfits = 0;            ///< in a row
  double usual_share = 0.0;           ///< of keypoints that fit the map; 0: not known yet
  double verdict = 0.0;               ///< log-odds that registration gave the scan that was verified last
  std::optional<Pose> last_in_map;    ///< T_map_lidar of the scan before, where it fitted
  std::optional<Pose> verified_at;    ///< T_odometry_lidar of the scan that was verified last
  std::optional<Pose> compared_at;    ///< and of the one that was compared with the whole map
  bool verification_pending = false;  ///< the sensor may have been carried off, until the whole map has been asked
  bool overtaken = false;             ///< another place fitted the scan better that was compared last
  std::optional<std::vector<LocalizationHypothesis>>
      searched;                             ///< what the whole map said of this scan, if it was asked
  std::optional<surfels::LocalMap> around;  ///< the map around the sensor
  Eigen::Vector3d around_at = Eigen::Vector3d::Zero();

  /// Pose and motion of a raw scan in the map, from a pose near; nothing where they cannot be told.
  std::optional<internal::SweepInMap> sweep_in_map(const odometry::TrackedScan& tracked, const Pose& near);
  /// Own motion begins anew at this scan, which moves so: the next one is expected where that leads.
  void begin_odometry(const odometry::TrackedScan& tracked, const Vector6d& velocity);
  Followed followed(const PointCloud& cloud, const Pose& predicted);
  void remember(const odometry::TrackedScan& tracked, Followed& followed);
  odometry::TrackedScan next_pose(const Scan& scan);
  void renew_surroundings(const Eigen::Vector3d& position);
  /// Own motion that leads elsewhere than the map, which registration was asked about, begins anew with the map's
  /// motion: along smooth walls a sensor may seem to stand still.
  void reset_odometry(const odometry::TrackedScan& tracked, const Pose& T_map_lidar, const Pose& predicted);
  std::vector<Pose> priors(const Pose& T_odometry_lidar) const;
  std::vector<Pose> in_question(const odometry::TrackedScan& tracked, const Pose& T_map_lidar) const;
  /// Whether own motion may not have led here: fewer keypoints fit than usual, scans are missing, or map and own motion
  /// disagree.
  bool doubtful(const Followed& followed) const;
  /// Whether so much has been driven since `last`, or there was none.
  static bool is_due(const std::optional<Pose>& last, const odometry::TrackedScan& tracked, double after_m);
  double compare_after_m() const { return overtaken ? options.verify_every_m : options.compare_every_m; }
  /// With near matches only, and where fewer of them hold than usual, with far ones too, whichever holds more
  /// keypoints: walls may draw a scan along, and the own motion may be wrong.
  odometry::Alignment align_to_map(const PointCloud& cloud, const Pose& predicted);
};

/// `pose`, or what registration says where that is apart.
inline Pose unless_apart(const Pose& pose, const Pose& registered) {
  return pose_error(registered, pose).translation_m > kDisagreementM ? registered : pose;
}

}  // namespace loopmark::localization
