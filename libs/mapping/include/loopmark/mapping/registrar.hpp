// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/registration/engine.hpp"

namespace loopmark::mapping {

/// What mapping needs of global registration. Keyframes are handled as bytes, which lie in the run folder: at most
/// 1 MB each. Calls come from several threads at once.
class Registrar {
 public:
  virtual ~Registrar() = default;

  /// Everything registration needs of a (deskewed) scan.
  virtual std::string prepare(const PointCloud& cloud) const = 0;

  /// The same of several scans joined in the frame of a submap; T_submap_scan[i] places clouds[i].
  virtual std::string join(const std::vector<PointCloud>& clouds, const std::vector<Pose>& T_submap_scan) const = 0;

  /// Where the source stands in the target, with no initial guess.
  virtual registration::RegistrationResult align(const std::string& source, const std::string& target) const = 0;

  /// How well a motion holds that something else claims.
  virtual registration::RegistrationResult verify(const std::string& source, const std::string& target,
                                                  const Pose& T_target_source) const = 0;
};

}  // namespace loopmark::mapping
