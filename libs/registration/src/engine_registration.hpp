// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The engine as a PairRegistration.
#pragma once

#include "loopmark/registration/pair_registration.hpp"

namespace loopmark::registration::internal {

class EnginePreparedCloud : public PreparedCloud {
 public:
  explicit EnginePreparedCloud(PreparedScan scan) : scan_(std::move(scan)) {}
  const PreparedScan& scan() const { return scan_; }
  std::string to_bytes() const override { return scan_.to_bytes(); }

 private:
  PreparedScan scan_;
};

class EngineRegistration : public PairRegistration {
 public:
  explicit EngineRegistration(const EngineOptions& options) : options_(options) {}

  const std::string& name() const override { return name_; }
  PreparedCloudPtr prepare(const PointCloud& cloud) const override;
  PreparedCloudPtr prepare_submap(const std::vector<PointCloud>& clouds,
                                  const std::vector<Pose>& T_submap_scan) const override;
  PreparedCloudPtr restore(const std::string& bytes) const override;
  RegistrationResult align(const PreparedCloud& source, const PreparedCloud& target) const override;
  RegistrationResult verify(const PreparedCloud& source, const PreparedCloud& target,
                            const Pose& T_target_source) const override;

 private:
  EngineOptions options_;
  std::string name_ = "engine";
};

}  // namespace loopmark::registration::internal
