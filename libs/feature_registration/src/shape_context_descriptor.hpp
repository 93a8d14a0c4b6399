// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/feature_registration/descriptor.hpp"

namespace loopmark::feature_registration::internal {

/// The Fourier shape context of what stands on the ground.
std::unique_ptr<Descriptor> make_shape_context_descriptor(const FeatureRegistrationOptions& options);

}  // namespace loopmark::feature_registration::internal
