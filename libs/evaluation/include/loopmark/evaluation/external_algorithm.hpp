// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Programs that compete through a line protocol on their standard input and output (docs/guide/evaluation.md).
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "loopmark/evaluation/algorithm.hpp"

namespace loopmark::evaluation {

struct ExternalOptions {
  std::string command;            ///< run by /bin/sh -c
  double time_limit_s = 30.0;     ///< for one pair
  double start_limit_s = 60.0;    ///< until the program says that it is ready
  std::filesystem::path scratch;  ///< folder for the clouds; empty: the system's
};

/// Starts the program once to see that it speaks the protocol; throws InputError when it does not. A pair on which
/// it hangs, dies, or answers nonsense counts as a failure with that reason, and the program is started anew.
std::unique_ptr<RegistrationAlgorithm> make_external_algorithm(std::string name, const ExternalOptions& options);

}  // namespace loopmark::evaluation
