// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/outcome.hpp"

#include <array>
#include <utility>

#include "loopmark/core/error.hpp"

namespace loopmark::evaluation {
namespace {

constexpr std::array<std::pair<AnswerStatus, const char*>, 5> kStatusNames = {{
    {AnswerStatus::kAnswered, "answered"},
    {AnswerStatus::kAbstained, "abstained"},
    {AnswerStatus::kFailed, "failed"},
    {AnswerStatus::kTimeLimit, "time limit"},
    {AnswerStatus::kCrashed, "crashed"},
}};

}  // namespace

void check(const SuccessCriterion& criterion) {
  require_option(criterion.max_rotation_deg > 0.0, "max_rotation_deg", "must be above 0");
  require_option(criterion.max_translation_m > 0.0, "max_translation_m", "must be above 0");
}

const char* to_string(AnswerStatus status) {
  for (const auto& [value, name] : kStatusNames) {
    if (value == status) {
      return name;
    }
  }
  return "?";
}

AnswerStatus answer_status_from(const std::string& name) {
  for (const auto& [value, text] : kStatusNames) {
    if (name == text) {
      return value;
    }
  }
  throw InputError("unknown status of an answer: " + name);
}

Outcome judge(std::size_t pair, const std::string& algorithm, Answer answer, const Pose& truth,
              const SuccessCriterion& criterion) {
  Outcome outcome{pair, algorithm, std::move(answer), false, {}, false};
  outcome.error = pose_error(outcome.answer.T_target_source, truth);
  outcome.success = outcome.answer.has_motion() && outcome.error.rotation_deg < criterion.max_rotation_deg &&
                    outcome.error.translation_m < criterion.max_translation_m;
  return outcome;
}

Outcome judge_negative(std::size_t pair, const std::string& algorithm, Answer answer) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {pair, algorithm, std::move(answer), true, {kNaN, kNaN}, false};
}

}  // namespace loopmark::evaluation
