// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "loopmark/evaluation/algorithm.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/number_rows.hpp"

namespace loopmark::evaluation {
namespace {

class MotionsAlgorithm : public RegistrationAlgorithm {
 public:
  MotionsAlgorithm(std::string name, std::vector<Pose> motions)
      : name_(std::move(name)), motions_(std::move(motions)) {}

  const std::string& name() const override { return name_; }
  bool needs_scans() const override { return false; }

  std::string settings() const override {
    std::string text;
    for (const Pose& motion : motions_) {
      text::append_motion(text, motion);
    }
    return "motions " + storage::sha256_hex(text);
  }

  Answer answer(const PairTask& task) override {
    Answer answer;
    if (task.index < motions_.size()) {
      answer.T_target_source = motions_[task.index];
    } else {
      answer.status = AnswerStatus::kFailed;
      answer.note = "no motion for this pair in the file";
    }
    return answer;
  }

 private:
  std::string name_;
  std::vector<Pose> motions_;
};

}  // namespace

std::unique_ptr<RegistrationAlgorithm> make_motions_algorithm(std::string name, std::vector<Pose> motions) {
  return std::make_unique<MotionsAlgorithm>(std::move(name), std::move(motions));
}

}  // namespace loopmark::evaluation
