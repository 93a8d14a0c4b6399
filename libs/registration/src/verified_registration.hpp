// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// One algorithm's motions under another one's judgement.
#pragma once

#include "loopmark/registration/pair_registration.hpp"

namespace loopmark::registration::internal {

/// A cloud as both have made it ready.
class DoublyPreparedCloud : public PreparedCloud {
 public:
  DoublyPreparedCloud(PreparedCloudPtr of_finder, PreparedCloudPtr of_verifier)
      : finder(std::move(of_finder)), verifier(std::move(of_verifier)) {}
  std::string to_bytes() const override;

  const PreparedCloudPtr finder;
  const PreparedCloudPtr verifier;
};

class VerifiedRegistration : public PairRegistration {
 public:
  VerifiedRegistration(PairRegistrationPtr finder, PairRegistrationPtr verifier)
      : finder_(std::move(finder)), verifier_(std::move(verifier)) {}

  const std::string& name() const override { return finder_->name(); }
  PreparedCloudPtr prepare(const PointCloud& cloud) const override;
  PreparedCloudPtr prepare_submap(const std::vector<PointCloud>& clouds,
                                  const std::vector<Pose>& T_submap_scan) const override;
  PreparedCloudPtr restore(const std::string& bytes) const override;
  RegistrationResult align(const PreparedCloud& source, const PreparedCloud& target) const override;
  RegistrationResult verify(const PreparedCloud& source, const PreparedCloud& target,
                            const Pose& T_target_source) const override;

 private:
  PairRegistrationPtr finder_;
  PairRegistrationPtr verifier_;
};

}  // namespace loopmark::registration::internal
