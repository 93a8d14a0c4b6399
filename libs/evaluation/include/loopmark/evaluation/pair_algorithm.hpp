// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "loopmark/evaluation/algorithm.hpp"
#include "loopmark/registration/pair_registration.hpp"

namespace loopmark::evaluation {

/// Any PairRegistration as a competitor, under its own name: the engine, or one of the user's. `settings`: text that
/// changes when its answers may change.
std::unique_ptr<RegistrationAlgorithm> make_pair_algorithm(registration::PairRegistrationPtr registration,
                                                           std::string settings);

}  // namespace loopmark::evaluation
