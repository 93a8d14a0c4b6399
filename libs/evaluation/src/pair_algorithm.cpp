// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/pair_algorithm.hpp"

#include "loopmark/core/progress.hpp"

namespace loopmark::evaluation {
namespace {

class PairAlgorithm : public RegistrationAlgorithm {
 public:
  PairAlgorithm(registration::PairRegistrationPtr registration, std::string settings)
      : registration_(std::move(registration)), settings_(std::move(settings)) {}

  const std::string& name() const override { return registration_->name(); }
  std::string settings() const override { return settings_; }

  Answer answer(const PairTask& task) override {
    const Stopwatch whole;
    const registration::PreparedCloudPtr source = registration_->prepare(task.scans->source());
    const registration::PreparedCloudPtr target = registration_->prepare(task.scans->target());
    const double prepared = whole.seconds();
    const registration::RegistrationResult result = registration_->align(*source, *target);
    return answer_of(result, prepared, whole.seconds());
  }

 private:
  static Answer answer_of(const registration::RegistrationResult& result, double prepare_seconds, double seconds) {
    Answer answer;
    answer.T_target_source = result.T_target_source;
    answer.status = result.answered ? AnswerStatus::kAnswered : AnswerStatus::kAbstained;
    answer.p_correct = result.p_correct;
    answer.note = result.reason;
    if (!result.modes.empty()) {
      answer.numbers = result.modes.front().evidence;
      answer.note += (answer.note.empty() ? "from " : "; from ") + result.modes.front().origin;
    }
    answer.timings = {{"prepare both scans", prepare_seconds}};
    answer.timings.insert(answer.timings.end(), result.timings.begin(), result.timings.end());
    answer.paper_seconds = seconds - prepare_seconds;
    answer.total_seconds = seconds;
    return answer;
  }

  registration::PairRegistrationPtr registration_;
  std::string settings_;
};

}  // namespace

std::unique_ptr<RegistrationAlgorithm> make_pair_algorithm(registration::PairRegistrationPtr registration,
                                                           std::string settings) {
  return std::make_unique<PairAlgorithm>(std::move(registration), std::move(settings));
}

}  // namespace loopmark::evaluation
