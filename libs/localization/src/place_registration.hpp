// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "loopmark/registration/engine.hpp"
#include "place_hypothesis.hpp"
#include "place_submaps.hpp"

namespace loopmark::localization::internal {

using SubmapHypotheses = std::vector<SubmapHypothesis>;

void append(SubmapHypotheses& all, SubmapHypotheses more);

/// Registers a scan to submaps of a map. Answers of log-odds below -5 are left out; those given are not yet distinct,
/// and do not depend on the number of threads.
class PlaceRegistration {
 public:
  /// The submaps must outlive it.
  PlaceRegistration(const PlaceSubmaps& submaps, const RelocalizationOptions& options,
                    const registration::EngineOptions& engine);

  registration::PreparedScan prepared(const PointCloud& scan) const;

  /// With no idea of where in them the scan stands.
  SubmapHypotheses to_submaps(const registration::PreparedScan& scan, const std::vector<std::size_t>& centers) const;

  /// Poses that are believed, judged as those that were searched are.
  SubmapHypotheses at_poses(const registration::PreparedScan& scan, const std::vector<Pose>& priors) const;

  /// What the submap around a pose and the one that stands off say of it together: log-odds, at least kNotThere each,
  /// that compare with those of another pose. Nothing where no submap is around it.
  std::optional<double> verdict(const registration::PreparedScan& scan, const Pose& T_map_lidar) const;

  /// With each distinct answer, what those submaps say of it that see most of what the scan sees: the one by which it
  /// was found may be a hundred metres away.
  SubmapHypotheses judged_nearby(const registration::PreparedScan& scan, SubmapHypotheses found) const;

 private:
  SubmapHypotheses modes(const registration::RegistrationResult& result, std::size_t center) const;
  SubmapHypotheses verify_at(const registration::PreparedScan& scan, std::size_t center, const Pose& T_map_lidar) const;

  const PlaceSubmaps& submaps_;
  RelocalizationOptions options_;
  registration::EngineOptions engine_;
};

}  // namespace loopmark::localization::internal
