// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What competes in an experiment.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/evaluation/outcome.hpp"
#include "loopmark/feature_registration/options.hpp"

namespace loopmark::evaluation {

/// The two scans of a pair, and what several algorithms need of them; made when first asked for. One thread.
class PairScans {
 public:
  PairScans(PointCloud source, PointCloud target) : source_(std::move(source)), target_(std::move(target)) {}

  const PointCloud& source() const { return source_; }
  const PointCloud& target() const { return target_; }
  /// One original point a voxel of 0.3 m (paper, appendix "Implementation Details").
  const PointCloud& small_source();
  const PointCloud& small_target();

  /// What make() returns, made once for each key: lets algorithms that need the same share it.
  template <class T, class Make>
  const T& shared(const std::string& key, const Make& make) {
    std::shared_ptr<const void>& place = shared_[key];
    if (!place) {
      place = std::make_shared<const T>(make());
    }
    return *static_cast<const T*>(place.get());
  }

 private:
  PointCloud source_, target_;
  std::map<std::string, std::shared_ptr<const void>> shared_;
};

/// One pair as an algorithm gets it.
struct PairTask {
  std::size_t index = 0;  ///< place in the set; negatives follow behind the positives
  pair_sets::PairKey key;
  PairScans* scans = nullptr;                              ///< null where no algorithm needs scans; perturbed already
  const Pose* perturbation = nullptr;                      ///< by which the source was moved; null: it was not
  const std::map<std::string, Answer>* earlier = nullptr;  ///< answers to this pair of the algorithms before
};

/// Finds the motion between two scans. Several threads call answer() at the same time, for different pairs.
class RegistrationAlgorithm {
 public:
  virtual ~RegistrationAlgorithm() = default;
  virtual const std::string& name() const = 0;
  /// Text that changes when the answers may change (options, a command line, a file's hash).
  virtual std::string settings() const = 0;
  virtual bool needs_scans() const { return true; }
  virtual Answer answer(const PairTask& task) = 0;
};

using AlgorithmList = std::vector<std::unique_ptr<RegistrationAlgorithm>>;

/// Whose descriptors algorithms use. With a folder those made elsewhere: keypoints and descriptors of a frame are read
/// from folder/SESSION/FRAME.npz (read_descriptors), FRAME as a plain number or with six digits. Without one `domain`
/// is the name of a descriptor (feature_registration::descriptors()). Algorithms on them are called "NAME@DOMAIN".
struct DescriptorSource {
  std::string domain;  ///< empty: the descriptor of the algorithm's own options
  std::filesystem::path folder;
};

/// A variant of the paper's pipeline (named_algorithms()), without its refinement. "NAME#3" is NAME with the seed 3.
/// Algorithms that describe scans alike share the descriptors and the matches of a pair.
std::unique_ptr<RegistrationAlgorithm> make_named_algorithm(const std::string& name,
                                                            const DescriptorSource& descriptors = {});

/// The paper's pipeline with options of one's own; `settings` are the options as text.
std::unique_ptr<RegistrationAlgorithm> make_configured_algorithm(
    const std::string& name, const feature_registration::FeatureRegistrationOptions& options,
    const std::string& settings, const DescriptorSource& descriptors = {});

/// Answers that were found before: one motion a pair. Pairs behind the last (negatives) fail.
std::unique_ptr<RegistrationAlgorithm> make_motions_algorithm(std::string name, std::vector<Pose> motions);

/// The answers of an algorithm earlier in the list, refined: "BASE+METHOD". Methods: refinement_methods().
std::unique_ptr<RegistrationAlgorithm> make_refined_algorithm(const std::string& base, const std::string& method);

/// Names of the refinements, the paper's three first.
std::vector<std::string> refinement_methods();

}  // namespace loopmark::evaluation
