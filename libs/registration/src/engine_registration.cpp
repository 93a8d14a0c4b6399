// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine_registration.hpp"

#include <stdexcept>

namespace loopmark::registration {
namespace {

/// Throws std::invalid_argument on what another algorithm has prepared.
const PreparedScan& scan_of(const PreparedCloud& cloud) {
  const auto* const own = dynamic_cast<const internal::EnginePreparedCloud*>(&cloud);
  if (own == nullptr) {
    throw std::invalid_argument("the engine registers what it has prepared itself");
  }
  return own->scan();
}

}  // namespace

namespace internal {

PreparedCloudPtr EngineRegistration::prepare(const PointCloud& cloud) const {
  return std::make_shared<EnginePreparedCloud>(prepare_scan(cloud, options_));
}

PreparedCloudPtr EngineRegistration::prepare_submap(const std::vector<PointCloud>& clouds,
                                                    const std::vector<Pose>& T_submap_scan) const {
  return std::make_shared<EnginePreparedCloud>(registration::prepare_submap(clouds, T_submap_scan, options_));
}

PreparedCloudPtr EngineRegistration::restore(const std::string& bytes) const {
  return std::make_shared<EnginePreparedCloud>(PreparedScan::from_bytes(bytes));
}

RegistrationResult EngineRegistration::align(const PreparedCloud& source, const PreparedCloud& target) const {
  return register_scans(scan_of(source), scan_of(target), options_);
}

RegistrationResult EngineRegistration::verify(const PreparedCloud& source, const PreparedCloud& target,
                                              const Pose& T_target_source) const {
  return verify_motion(scan_of(source), scan_of(target), T_target_source, options_);
}

}  // namespace internal

PairRegistrationPtr engine_registration(const EngineOptions& options) {
  return std::make_shared<internal::EngineRegistration>(options);
}

}  // namespace loopmark::registration
