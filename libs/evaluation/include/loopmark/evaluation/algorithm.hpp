// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What competes in an experiment.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/evaluation/outcome.hpp"

namespace loopmark {

/// One pair as an algorithm gets it. The clouds are null where the experiment has no data (motions files only).
struct PairTask {
  std::size_t index = 0;                   ///< place in the set; negatives follow behind the positives
  PairKey key;
  const PointCloud* source = nullptr;      ///< perturbed already, where the experiment perturbs
  const PointCloud* target = nullptr;
};

/// Finds the motion between two scans. Several threads call answer() at the same time.
class RegistrationAlgorithm {
 public:
  virtual ~RegistrationAlgorithm() = default;
  virtual const std::string& name() const = 0;
  virtual bool needs_clouds() const { return true; }
  virtual Answer answer(const PairTask& task) = 0;
};

using AlgorithmList = std::vector<std::unique_ptr<RegistrationAlgorithm>>;

/// The registration engine ("engine").
std::unique_ptr<RegistrationAlgorithm> make_engine_algorithm(const EngineOptions& options);

/// Answers that were found before: one motion a pair. Pairs behind the last (negatives) fail.
std::unique_ptr<RegistrationAlgorithm> make_motions_algorithm(std::string name, std::vector<Pose> motions);

}  // namespace loopmark
