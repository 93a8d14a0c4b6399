// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/algorithm.hpp"
#include "loopmark/registration/named_algorithms.hpp"
#include "loopmark/registration/paper_pipeline.hpp"

namespace loopmark {
namespace {

double seconds_of(const std::vector<StageTime>& stages) {
  double seconds = 0.0;
  for (const StageTime& stage : stages) {
    seconds += stage.seconds;
  }
  return seconds;
}

/// The named variants differ in whether ground is described; everything else of the description is the same.
std::string description_key(const PaperOptions& options) {
  return std::string(options.match_ground ? "all points" : "without ground") + ", voxel " + std::to_string(options.voxel_m) +
         (options.voxel_point == VoxelPoint::kFirst ? " first" : " centroid") + ", normals " +
         std::to_string(options.normals.radius_m) + ", fpfh " + std::to_string(options.fpfh.radius_m);
}

class PaperAlgorithm : public RegistrationAlgorithm {
 public:
  PaperAlgorithm(std::string name, PaperOptions options)
      : name_(std::move(name)), options_(std::move(options)), key_(description_key(options_)) {
    options_.refine = false;
  }

  const std::string& name() const override { return name_; }
  std::string settings() const override {
    return "the paper's pipeline as " + name_ + ", seed " + std::to_string(options_.ransac.seed) + ", " + key_;
  }

  Answer answer(const PairTask& task) override {
    const DescribedScan& source = described(*task.scans, task.scans->source(), "source");
    const DescribedScan& target = described(*task.scans, task.scans->target(), "target");
    return answer_of(register_described(source, target, options_), source, target);
  }

 private:
  const DescribedScan& described(PairScans& scans, const PointCloud& cloud, const std::string& which) const {
    return scans.shared<DescribedScan>(which + ", " + key_, [&] { return describe_scan(cloud, options_); });
  }

  static Answer answer_of(const PaperResult& result, const DescribedScan& source, const DescribedScan& target) {
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
  PaperOptions options_;
  std::string key_;
};

}  // namespace

std::unique_ptr<RegistrationAlgorithm> make_named_algorithm(const std::string& name) {
  const std::size_t mark = name.find('#');
  PaperOptions options = named_algorithm(name.substr(0, mark));
  if (mark != std::string::npos) {
    const std::string number = name.substr(mark + 1);
    if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos) {
      throw InputError("--algorithms " + name + ": a number must follow #, the seed of this run");
    }
    options.ransac.seed = std::stoull(number);
  }
  return std::make_unique<PaperAlgorithm>(name, std::move(options));
}

}  // namespace loopmark
