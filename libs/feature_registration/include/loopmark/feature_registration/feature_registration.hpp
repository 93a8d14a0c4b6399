// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The paper's pipeline as a PairRegistration.
#pragma once

#include <string>

#include "loopmark/feature_registration/options.hpp"
#include "loopmark/registration/pair_registration.hpp"

namespace loopmark::feature_registration {

/// Features, matches, filter, robust estimation and ICP under one name. It answers whenever the estimator found a
/// motion; p_correct is then the share of ICP's inliers, which is no calibrated probability (see
/// registration::verified_registration for one). Bytes of a prepared scan hold its points: restoring describes anew.
registration::PairRegistrationPtr feature_registration(const std::string& name,
                                                       const FeatureRegistrationOptions& options);

}  // namespace loopmark::feature_registration
