// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What register and replay share: one registration, how it is shown, and how it is recorded.
#pragma once

#include <filesystem>
#include <string>

#include "loopmark/registration/engine.hpp"
#include "loopmark/workflows/options.hpp"

namespace loopmark::workflows {

/// One registration with all that went into it.
struct RegisterRun {
  PointCloud source;
  PointCloud target;
  std::string source_name;
  std::string target_name;
  std::string algorithm = "engine";  ///< or custom (ProgramOptions::paper), or one of named_algorithms()
  std::string descriptor;  ///< of the paper's variants: a name, or a folder of .npz files named like the scans;
                           ///< empty: the variant's own
  registration::RegistrationResult result;
};

/// Runs `algorithm` on the clouds and fills the result. Throws InputError for an unknown algorithm or descriptor.
void run_registration(RegisterRun& run, const ProgramOptions& options);

/// The motion, the verdict and the evidence, for people.
std::string registration_text(const RegisterRun& run);

/// The same as JSON: T_target_source (16 numbers, row-major), p_correct, answered, reason, covariance, modes, timings.
std::string registration_json(const RegisterRun& run);

/// Before and after, from above and from the side.
void write_registration_picture(const RegisterRun& run, const std::filesystem::path& path);

/// Saves clouds, options and result as a folder that read_record opens again. Throws InputError when it exists.
void write_record(const RegisterRun& run, const ProgramOptions& options, const std::filesystem::path& folder);

/// A record: the run with its recorded motion and probability in `result`, and the options it ran with.
struct Record {
  RegisterRun run;
  ProgramOptions options;
};
Record read_record(const std::filesystem::path& folder);

}  // namespace loopmark::workflows
