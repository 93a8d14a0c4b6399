// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pair_registration.hpp"

#include "loopmark/feature_registration/feature_registration.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"

namespace loopmark::workflows::internal {

registration::PairRegistrationPtr pair_registration_of(const ProgramOptions& options) {
  registration::PairRegistrationPtr engine = registration::engine_registration(options.registration);
  const std::string& name = options.slam.registration;
  if (name == engine->name()) {
    return engine;
  }
  const feature_registration::FeatureRegistrationOptions& variant =
      name == "custom" ? options.paper : feature_registration::named_algorithm(name);
  return registration::verified_registration(feature_registration::feature_registration(name, variant),
                                             std::move(engine));
}

}  // namespace loopmark::workflows::internal
