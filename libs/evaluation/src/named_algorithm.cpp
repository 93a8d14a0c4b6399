// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <utility>

#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/algorithm.hpp"
#include "loopmark/feature_registration/descriptor.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"
#include "loopmark/feature_registration/pipeline.hpp"
#include "loopmark/features/descriptor_file.hpp"

namespace loopmark::evaluation {
namespace {

double seconds_of(const std::vector<registration::StageTime>& stages) {
  double seconds = 0.0;
  for (const registration::StageTime& stage : stages) {
    seconds += stage.seconds;
  }
  return seconds;
}

/// What variants that describe scans alike have in common.
std::string description_key(const feature_registration::FeatureRegistrationOptions& options) {
  std::string key = options.descriptor + ", voxel " + std::to_string(options.voxel_m) +
                    (options.voxel_point == feature_registration::VoxelPoint::kFirst ? " first" : " centroid");
  if (options.descriptor == "fpfh") {
    key += std::string(options.match_ground ? ", all points" : ", without ground") + ", normals " +
           std::to_string(options.normals.radius_m) + ", radius " + std::to_string(options.fpfh.radius_m);
  }
  return key;
}

/// The file of a frame's descriptors. Throws InputError when there is none.
std::filesystem::path descriptor_file(const std::filesystem::path& folder, int session, int frame) {
  char padded[32];
  std::snprintf(padded, sizeof padded, "%06d.npz", frame);
  const std::filesystem::path of_session = folder / std::to_string(session);
  for (const std::string& name : {std::string(padded), std::to_string(frame) + ".npz"}) {
    if (std::filesystem::exists(of_session / name)) {
      return of_session / name;
    }
  }
  throw InputError((of_session / padded).string(), "", "no such file",
                   "--features wants FOLDER/SESSION/FRAME.npz for every frame of the set");
}

class PaperAlgorithm : public RegistrationAlgorithm {
 public:
  /// `features`: folder of descriptors made elsewhere; empty: those of options.descriptor. `key`: what variants that
  /// describe scans alike share.
  PaperAlgorithm(std::string name, feature_registration::FeatureRegistrationOptions options,
                 std::filesystem::path features, std::string key, std::string settings)
      : name_(std::move(name)),
        options_(options),
        features_(std::move(features)),
        key_(std::move(key)),
        settings_(std::move(settings)) {
    options_.refine = false;
  }

  const std::string& name() const override { return name_; }
  std::string settings() const override { return settings_; }

  Answer answer(const PairTask& task) override {
    const feature_registration::DescribedScan& source = task.scans->shared<feature_registration::DescribedScan>(
        "source, " + key_,
        [&] { return described(task.scans->source(), task.key.session, task.key.source, task.perturbation); });
    const feature_registration::DescribedScan& target = task.scans->shared<feature_registration::DescribedScan>(
        "target, " + key_,
        [&] { return described(task.scans->target(), task.key.target_session, task.key.target, nullptr); });
    feature_registration::require_comparable(source, origin_of(task.key.session, task.key.source), target,
                                             origin_of(task.key.target_session, task.key.target));
    const feature_registration::ScanMatches& matches = task.scans->shared<feature_registration::ScanMatches>(
        "matches, " + key_, [&] { return feature_registration::match_described(source, target); });
    return answer_of(feature_registration::register_matched(source, target, matches, options_), source, target);
  }

 private:
  std::string origin_of(int session, int frame) const {
    return features_.empty() ? "session " + std::to_string(session) + " frame " + std::to_string(frame)
                             : descriptor_file(features_, session, frame).string();
  }

  feature_registration::DescribedScan described(const PointCloud& cloud, int session, int frame,
                                                const Pose* moved) const {
    if (features_.empty()) {
      return feature_registration::describe_scan(cloud, options_);
    }
    features::DescriptorFile file = features::read_descriptors(descriptor_file(features_, session, frame));
    for (Eigen::Vector3f& point : file.points) {
      point = moved == nullptr ? point : Eigen::Vector3f((*moved * point.cast<double>()).cast<float>());
    }
    return feature_registration::described_scan(std::move(file.points), std::move(file.descriptors), cloud, options_);
  }

  static Answer answer_of(const feature_registration::FeatureRegistrationResult& result,
                          const feature_registration::DescribedScan& source,
                          const feature_registration::DescribedScan& target) {
    Answer answer;
    answer.T_target_source = result.T_target_source;
    answer.status = result.found ? AnswerStatus::kAnswered : AnswerStatus::kFailed;
    answer.note = to_string(result.estimate.stop);
    answer.numbers = {{"matches_initial", static_cast<double>(result.matches)},
                      {"matches_mutual", static_cast<double>(result.mutual_matches)},
                      {"matches_used", static_cast<double>(result.used_matches)},
                      {"inliers", static_cast<double>(result.estimate.inliers.size())},
                      {"iterations", static_cast<double>(result.estimate.iterations)}};
    for (const auto* stages : {&source.timings, &target.timings, &result.timings}) {
      answer.timings.insert(answer.timings.end(), stages->begin(), stages->end());
    }
    answer.paper_seconds = result.algorithm_seconds();
    answer.total_seconds = seconds_of(answer.timings);
    return answer;
  }

  std::string name_;
  feature_registration::FeatureRegistrationOptions options_;
  std::filesystem::path features_;
  std::string key_;
  std::string settings_;
};

/// "NAME#3" has the seed 3.
feature_registration::FeatureRegistrationOptions with_seed_of(
    const std::string& name, feature_registration::FeatureRegistrationOptions options) {
  const std::size_t mark = name.find('#');
  if (mark != std::string::npos) {
    const std::string number = name.substr(mark + 1);
    if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos) {
      throw InputError("--algorithms " + name + ": a number must follow #, the seed of this run");
    }
    options.ransac.seed = std::stoull(number);
  }
  return options;
}

/// With the descriptor that was asked for by name. Throws InputError when there is none of this name.
feature_registration::FeatureRegistrationOptions described_by(
    const DescriptorSource& descriptors, feature_registration::FeatureRegistrationOptions options) {
  if (!descriptors.domain.empty() && descriptors.folder.empty()) {
    options.descriptor = descriptors.domain;
    feature_registration::make_descriptor(options);
  }
  return options;
}

std::unique_ptr<RegistrationAlgorithm> make_paper_algorithm(
    const std::string& name, const feature_registration::FeatureRegistrationOptions& options,
    const DescriptorSource& descriptors, std::string key, const std::string& settings) {
  const auto& [domain, folder] = descriptors;
  if (folder.empty()) {
    const std::string full_name = domain.empty() ? name : name + "@" + domain;
    return std::make_unique<PaperAlgorithm>(full_name, options, "", std::move(key), settings);
  }
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(folder.string(), "", "no such folder", "--features NAME=FOLDER");
  }
  return std::make_unique<PaperAlgorithm>(name + "@" + domain, options, folder, "descriptors of " + folder.string(),
                                          settings + ", descriptors of " + folder.string());
}

}  // namespace

std::unique_ptr<RegistrationAlgorithm> make_named_algorithm(const std::string& name,
                                                            const DescriptorSource& descriptors) {
  const feature_registration::FeatureRegistrationOptions options = described_by(
      descriptors, with_seed_of(name, feature_registration::named_algorithm(name.substr(0, name.find('#')))));
  const std::string key = description_key(options);
  return make_paper_algorithm(
      name, options, descriptors, key,
      "the paper's pipeline as " + name + ", seed " + std::to_string(options.ransac.seed) + ", " + key);
}

std::unique_ptr<RegistrationAlgorithm> make_configured_algorithm(
    const std::string& name, const feature_registration::FeatureRegistrationOptions& options,
    const std::string& settings, const DescriptorSource& descriptors) {
  const feature_registration::FeatureRegistrationOptions own = described_by(descriptors, with_seed_of(name, options));
  check(own);
  const std::string described = settings + "descriptor: " + own.descriptor + "\n";
  return make_paper_algorithm(name, own, descriptors, "configured: " + described,
                              described + "seed: " + std::to_string(own.ransac.seed));
}

}  // namespace loopmark::evaluation
