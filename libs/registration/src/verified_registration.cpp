// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "verified_registration.hpp"

#include <stdexcept>

#include "loopmark/storage/byte_stream.hpp"

namespace loopmark::registration {
namespace {

/// Throws std::invalid_argument on what another algorithm has prepared.
const internal::DoublyPreparedCloud& both_of(const PreparedCloud& cloud) {
  const auto* const own = dynamic_cast<const internal::DoublyPreparedCloud*>(&cloud);
  if (own == nullptr) {
    throw std::invalid_argument("a verified registration registers what it has prepared itself");
  }
  return *own;
}

}  // namespace

namespace internal {

std::string DoublyPreparedCloud::to_bytes() const {
  storage::ByteWriter writer;
  writer.text(finder->to_bytes());
  writer.text(verifier->to_bytes());
  return storage::sealed(writer.bytes());
}

PreparedCloudPtr VerifiedRegistration::prepare(const PointCloud& cloud) const {
  return std::make_shared<DoublyPreparedCloud>(finder_->prepare(cloud), verifier_->prepare(cloud));
}

PreparedCloudPtr VerifiedRegistration::prepare_submap(const std::vector<PointCloud>& clouds,
                                                      const std::vector<Pose>& T_submap_scan) const {
  return std::make_shared<DoublyPreparedCloud>(finder_->prepare_submap(clouds, T_submap_scan),
                                               verifier_->prepare_submap(clouds, T_submap_scan));
}

PreparedCloudPtr VerifiedRegistration::restore(const std::string& bytes) const {
  const std::string content = storage::unsealed(bytes, "prepared scan");
  storage::ByteReader reader(content);
  const std::string of_finder = reader.text();
  const std::string of_verifier = reader.text();
  return std::make_shared<DoublyPreparedCloud>(finder_->restore(of_finder), verifier_->restore(of_verifier));
}

RegistrationResult VerifiedRegistration::align(const PreparedCloud& source, const PreparedCloud& target) const {
  RegistrationResult found = finder_->align(*both_of(source).finder, *both_of(target).finder);
  if (!found.answered) {
    return found;
  }
  RegistrationResult judged = verify(source, target, found.T_target_source);
  judged.timings.insert(judged.timings.begin(), found.timings.begin(), found.timings.end());
  for (RegistrationMode& mode : judged.modes) {
    mode.origin = finder_->name();
  }
  return judged;
}

RegistrationResult VerifiedRegistration::verify(const PreparedCloud& source, const PreparedCloud& target,
                                                const Pose& T_target_source) const {
  return verifier_->verify(*both_of(source).verifier, *both_of(target).verifier, T_target_source);
}

}  // namespace internal

PairRegistrationPtr verified_registration(PairRegistrationPtr finder, PairRegistrationPtr verifier) {
  return std::make_shared<internal::VerifiedRegistration>(std::move(finder), std::move(verifier));
}

}  // namespace loopmark::registration
