// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/loop_decisions.hpp"

#include <sstream>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark::map_store {
namespace {

constexpr const char* kVetoWord = "veto";
constexpr const char* kForceWord = "force";

}  // namespace

std::filesystem::path decisions_file(const RunFolder& run) { return run / "records/decisions.rec"; }

std::string to_string(LoopOverride loop_override) {
  return loop_override == LoopOverride::kVeto ? "vetoed by a person" : "forced by a person";
}

std::optional<LoopOverride> loop_override_of(const std::vector<LoopDecision>& decisions, std::size_t source,
                                             std::size_t target) {
  for (const LoopDecision& decision : decisions) {
    if (decision.source == source && decision.target == target) {
      return decision.loop_override;
    }
  }
  return std::nullopt;
}

std::vector<LoopDecision> read_loop_decisions(const RunFolder& run) {
  std::vector<LoopDecision> decisions;
  for (const std::string& line : storage::read_records(decisions_file(run)).lines) {
    std::istringstream words(line);
    LoopDecision decision;
    std::string word;
    if (!(words >> decision.source >> decision.target >> word) || (word != kVetoWord && word != kForceWord)) {
      throw InputError(decisions_file(run).string(), "line " + std::to_string(decisions.size() + 1),
                       "is no decision: '" + line + "'", "delete the file to forget all decisions");
    }
    decision.loop_override = word == kVetoWord ? LoopOverride::kVeto : LoopOverride::kForce;
    decisions.push_back(decision);
  }
  return decisions;
}

void write_loop_decisions(const RunFolder& run, const std::vector<LoopDecision>& decisions) {
  std::filesystem::remove(decisions_file(run));
  if (decisions.empty()) {
    return;
  }
  storage::RecordWriter file(decisions_file(run));
  for (const LoopDecision& decision : decisions) {
    file.append(std::to_string(decision.source) + " " + std::to_string(decision.target) + " " +
                (decision.loop_override == LoopOverride::kVeto ? kVetoWord : kForceWord));
  }
}

}  // namespace loopmark::map_store
