// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/registration/pair_registration.hpp"
#include "loopmark/workflows/options.hpp"

namespace loopmark::workflows::internal {

/// What registers the keyframes of a map, by the option slam.registration: "engine"; or a named variant of the paper's
/// pipeline ("custom": that of the section paper), whose motions the engine verifies, so that P(correct) means the
/// same. Throws InputError listing the names when there is none of this name.
registration::PairRegistrationPtr pair_registration_of(const ProgramOptions& options);

}  // namespace loopmark::workflows::internal
