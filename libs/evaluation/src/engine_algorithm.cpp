// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "loopmark/core/progress.hpp"
#include "loopmark/evaluation/algorithm.hpp"

namespace loopmark::evaluation {
namespace {

class EngineAlgorithm : public RegistrationAlgorithm {
 public:
  EngineAlgorithm(const registration::EngineOptions& options, std::string settings)
      : options_(options), settings_(std::move(settings)) {}

  const std::string& name() const override { return name_; }
  std::string settings() const override { return settings_; }

  Answer answer(const PairTask& task) override {
    const Stopwatch whole;
    const registration::PreparedScan source = registration::prepare_scan(task.scans->source(), options_);
    const registration::PreparedScan target = registration::prepare_scan(task.scans->target(), options_);
    const double prepared = whole.seconds();
    const registration::RegistrationResult result = registration::register_scans(source, target, options_);
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

  registration::EngineOptions options_;
  std::string settings_;
  std::string name_ = "engine";
};

}  // namespace

std::unique_ptr<RegistrationAlgorithm> make_engine_algorithm(const registration::EngineOptions& options,
                                                             std::string settings) {
  return std::make_unique<EngineAlgorithm>(options, std::move(settings));
}

}  // namespace loopmark::evaluation
