// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/feature_registration/descriptor.hpp"

namespace loopmark::feature_registration::internal {

/// FPFH of every downsampled point with a normal, those of the ground left out where options.match_ground is false.
std::unique_ptr<Descriptor> make_fpfh_descriptor(const FeatureRegistrationOptions& options);

}  // namespace loopmark::feature_registration::internal
