// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What mapping, evaluation and relocalization need of an algorithm that registers two scans: the engine, the paper's
/// pipeline, or one of the user's own.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/registration/engine.hpp"

namespace loopmark::registration {

/// A scan, or a submap, as one algorithm has made it ready: immutable, and of use to that algorithm only.
class PreparedCloud {
 public:
  PreparedCloud() = default;
  virtual ~PreparedCloud() = default;
  PreparedCloud(const PreparedCloud&) = delete;
  PreparedCloud& operator=(const PreparedCloud&) = delete;

  /// What PairRegistration::restore makes the same of; for a keyframe's file.
  virtual std::string to_bytes() const = 0;
};

using PreparedCloudPtr = std::shared_ptr<const PreparedCloud>;

/// Registers two scans. All methods may be called from several threads at once.
class PairRegistration {
 public:
  virtual ~PairRegistration() = default;

  /// The name by which tables and options call it.
  virtual const std::string& name() const = 0;

  /// Everything that registration needs of a (deskewed) scan: points in the sensor's frame, metres.
  virtual PreparedCloudPtr prepare(const PointCloud& cloud) const = 0;

  /// The same of several scans joined in the frame of a submap; T_submap_scan[i] places clouds[i]. As it is here: of
  /// all points together.
  virtual PreparedCloudPtr prepare_submap(const std::vector<PointCloud>& clouds,
                                          const std::vector<Pose>& T_submap_scan) const;

  /// What to_bytes() gave. Throws InputError on bytes that are damaged.
  virtual PreparedCloudPtr restore(const std::string& bytes) const = 0;

  /// Where the source stands in the target, with no initial guess.
  virtual RegistrationResult align(const PreparedCloud& source, const PreparedCloud& target) const = 0;

  /// Refines and judges a motion that something else claims.
  virtual RegistrationResult verify(const PreparedCloud& source, const PreparedCloud& target,
                                    const Pose& T_target_source) const = 0;
};

using PairRegistrationPtr = std::shared_ptr<const PairRegistration>;

/// restore() of a file. Throws InputError naming the file when it is missing or damaged.
PreparedCloudPtr restore_file(const PairRegistration& registration, const std::filesystem::path& file);

/// The engine (engine.hpp), called "engine".
PairRegistrationPtr engine_registration(const EngineOptions& options);

/// Motions that `finder` finds, judged by `verifier`, with its evidence and its probability: any algorithm's answers
/// mean the same. Called "FINDER".
PairRegistrationPtr verified_registration(PairRegistrationPtr finder, PairRegistrationPtr verifier);

}  // namespace loopmark::registration
