// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <set>

#include "loopmark/evaluation/result_folder.hpp"
#include "loopmark/evaluation/result_tables.hpp"
#include "loopmark/storage/files.hpp"
#include "outcome_json.hpp"

namespace loopmark::evaluation {
namespace {

namespace fs = std::filesystem;

/// A cell of a CSV file; quoted where it must be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + '"';
}

std::string file_name(const std::string& algorithm) {
  std::string name = algorithm;
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return (std::isalnum(static_cast<unsigned char>(c)) == 0) && c != '-' && c != '+'; }, '_');
  return name;
}

std::string results_csv(const StoredResult& result) {
  std::string csv =
      "algorithm,pair,kind,session,source,target,target_session,status,success,te_m,re_deg,p_correct,x_m,y_m,z_m,"
      "roll_deg,pitch_deg,yaw_deg,distance_m,overlap,overlap_symmetric,note\n";
  for (const Outcome& outcome : result.outcomes) {
    const pair_sets::PairKey& key = result.set.key(outcome.pair);
    csv += cell(outcome.algorithm) + ',' + std::to_string(outcome.pair) +
           (outcome.negative ? ",negative," : ",positive,") + std::to_string(key.session) + ',' +
           std::to_string(key.source) + ',' + std::to_string(key.target) + ',' + std::to_string(key.target_session) +
           ',' + to_string(outcome.answer.status) + (outcome.success ? ",1," : ",0,") +
           text::fixed(outcome.error.translation_m, 6) + ',' + text::fixed(outcome.error.rotation_deg, 6) + ',' +
           text::fixed(outcome.answer.p_correct, 6);
    const pair_sets::RegistrationPair answer = pair_sets::make_pair(key, outcome.answer.T_target_source, 0.0, 0.0);
    for (const double value : answer.motion) {
      csv += ',' + text::fixed(value, 6);
    }
    if (outcome.negative) {
      csv += ",-,-,-,";
    } else {
      const pair_sets::RegistrationPair& pair = result.set.pairs[outcome.pair];
      csv += ',' + text::fixed(pair.motion.head<3>().norm(), 4) + ',' + text::fixed(pair.overlap, 6) + ',' +
             text::fixed(pair.overlap_symmetric, 6) + ',';
    }
    csv += cell(outcome.answer.note) + '\n';
  }
  return csv;
}

std::string times_csv(const StoredResult& result) {
  std::string csv = "algorithm,pair,stage,seconds\n";
  for (const Outcome& outcome : result.outcomes) {
    const std::string start = cell(outcome.algorithm) + ',' + std::to_string(outcome.pair) + ',';
    for (const registration::StageTime& stage : outcome.answer.timings) {
      csv += start + cell(stage.stage) + ',' + text::fixed(stage.seconds, 6) + '\n';
    }
    csv += start + "paper," + text::fixed(outcome.answer.paper_seconds, 6) + '\n';
    csv += start + "whole," + text::fixed(outcome.answer.total_seconds, 6) + '\n';
  }
  return csv;
}

void write_found_motions(const fs::path& folder, const StoredResult& result) {
  fs::create_directories(folder);
  for (const std::string& algorithm : result.experiment.algorithms) {
    std::vector<pair_sets::PairMotion> motions;
    for (const Outcome& outcome : result.outcomes) {
      if (outcome.algorithm == algorithm && !outcome.negative) {
        motions.push_back({result.set.key(outcome.pair), outcome.answer.T_target_source});
      }
    }
    pair_sets::write_motions(folder / (file_name(algorithm) + ".txt"), motions);
  }
}

}  // namespace

void write_products(const fs::path& folder, const StoredResult& result) {
  const auto summaries = summarise_all(result.outcomes, result.experiment.algorithms, result.set);
  const auto tests = paired_tests(result.outcomes, result.experiment.algorithms);
  storage::write_file_atomically(folder / "results.csv", results_csv(result));
  storage::write_file_atomically(folder / "times.csv", times_csv(result));
  write_found_motions(folder / "motions", result);
  fs::create_directories(folder / "tables");
  for (const text::TextTable& table : result_tables(result, summaries, tests)) {
    storage::write_file_atomically(folder / "tables" / (table.name + ".md"), text::to_markdown(table));
    storage::write_file_atomically(folder / "tables" / (table.name + ".tex"), text::to_latex(table));
  }
  storage::write_file_atomically(folder / "summary.json",
                                 internal::summary_to_json(result.experiment, summaries, tests));
}

}  // namespace loopmark::evaluation
