// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "found_place.hpp"
#include "loopmark/registration/engine.hpp"
#include "place_submaps.hpp"

namespace loopmark {

using Found = std::vector<FoundPlace>;

void append(Found& all, Found more);

/// Registers a scan to submaps of a map. Answers of log-odds below -5 are left out; those given are not yet distinct,
/// and do not depend on the number of threads.
class PlaceRegistration {
 public:
  /// The submaps must outlive it.
  PlaceRegistration(const PlaceSubmaps& submaps, const RelocalizationOptions& options, const EngineOptions& engine);

  PreparedScan prepared(const PointCloud& scan) const;

  /// With no idea of where in them the scan stands.
  Found to_submaps(const PreparedScan& scan, const std::vector<std::size_t>& centers) const;

  /// Poses that are believed, judged as those that were searched are.
  Found at_poses(const PreparedScan& scan, const std::vector<Pose>& believed) const;

  /// What the submap around a pose and the one that stands off say of it together: log-odds, at least kNotThere each,
  /// that compare with those of another pose. Nothing where no submap is around it.
  std::optional<double> verdict(const PreparedScan& scan, const Pose& T_map_lidar) const;

  /// With each distinct answer, what those submaps say of it that see most of what the scan sees: the one by which it
  /// was found may be a hundred metres away.
  Found judged_nearby(const PreparedScan& scan, Found found) const;

 private:
  Found modes(const RegistrationResult& result, std::size_t center) const;
  Found verify_at(const PreparedScan& scan, std::size_t center, const Pose& T_map_lidar) const;

  const PlaceSubmaps& submaps_;
  RelocalizationOptions options_;
  EngineOptions engine_;
};

}  // namespace loopmark
