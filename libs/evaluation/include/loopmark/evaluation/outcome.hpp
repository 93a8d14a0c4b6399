// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What an algorithm answered for one pair, and what it was worth.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "loopmark/core/options.hpp"
#include "loopmark/pair_sets/pair_set.hpp"
#include "loopmark/registration/engine.hpp"

namespace loopmark::evaluation {

/// When a registration counts as right: both errors strictly below (paper, Sec. 5).
struct SuccessCriterion {
  double max_rotation_deg = 5.0;   ///< RE, degrees
  double max_translation_m = 0.6;  ///< TE, metres

  bool operator==(const SuccessCriterion&) const = default;
};

template <class Visitor>
void describe(Visitor& v, SuccessCriterion& o) {
  v.field("max_rotation_deg", o.max_rotation_deg, "a registration is right below this rotation error, degrees");
  v.field("max_translation_m", o.max_translation_m, "a registration is right below this translation error, metres");
}
void check(const SuccessCriterion& criterion);

/// How a try ended.
enum class AnswerStatus {
  kAnswered,   ///< a motion that the algorithm stands for
  kAbstained,  ///< a motion, but the algorithm says that it does not know
  kFailed,     ///< no motion: the algorithm said so
  kTimeLimit,  ///< no motion within the time limit
  kCrashed,    ///< the program died or spoke nonsense
};
const char* to_string(AnswerStatus status);
AnswerStatus answer_status_from(const std::string& name);

/// What one algorithm says of one pair. Where there is no motion it is the identity, as the paper counts failures.
struct Answer {
  Pose T_target_source = Pose::Identity();
  AnswerStatus status = AnswerStatus::kAnswered;
  double p_correct = std::numeric_limits<double>::quiet_NaN();  ///< or the algorithm's score; NaN: it gives none
  std::string note;                ///< the reason of a failure; the source of the hypothesis
  registration::Evidence numbers;  ///< counts and evidence by name ("matches_initial", "matches_mutual", ...)
  std::vector<registration::StageTime> timings;  ///< seconds of each stage
  double paper_seconds =
      std::numeric_limits<double>::quiet_NaN();  ///< the paper's accounting: filtering, estimation, ICP
  double total_seconds = std::numeric_limits<double>::quiet_NaN();  ///< raw scans to answer

  bool has_motion() const { return status == AnswerStatus::kAnswered || status == AnswerStatus::kAbstained; }
};

/// An answer judged against the truth.
struct Outcome {
  std::size_t pair = 0;  ///< place in the set; negatives follow behind the positives
  std::string algorithm;
  Answer answer;
  bool negative = false;  ///< the pair shows two different places: no motion is right
  PoseError error;        ///< TE and RE; NaN for negatives
  bool success = false;   ///< a motion within the criterion, whether or not the algorithm stood for it
};

/// Judges an answer of a positive pair.
Outcome judge(std::size_t pair, const std::string& algorithm, Answer answer, const Pose& truth,
              const SuccessCriterion& criterion);

/// Records an answer to a pair that has none.
Outcome judge_negative(std::size_t pair, const std::string& algorithm, Answer answer);

}  // namespace loopmark::evaluation
