// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the paper reports ("Stress-Testing Point Cloud Registration on Automotive LiDAR", Drory, Giryes, Avidan):
/// shown beside our numbers and marked as theirs. Their matches are of learned features (FCGF), their times of their
/// machines (20-core Xeon E5-2630 at 2.2 GHz, Titan X); downsampling, features and first-nearest-neighbour search are
/// left out of them.
#pragma once

#include <string>
#include <vector>

namespace loopmark::evaluation::paper {

/// Tables "Evaluation of Registration Algorithms" and "Cross-Domain Evaluation" (tested on NuScenes-Boston).
struct EvaluationRow {
  std::string algorithm;
  double recall, seconds;          ///< algorithm only; recall in %
  double recall_icp, seconds_icp;  ///< with ICP
};
const std::vector<EvaluationRow>& evaluation();    ///< trained on Boston
const std::vector<EvaluationRow>& cross_domain();  ///< trained on Apollo

/// Tables "All Registration Sets Cross-Domain", its running times, and "Pair-Match Set Sizes".
struct DomainRow {
  std::string test, train;
  std::vector<double> recall;  ///< %, in the order of domain_algorithms()
  std::vector<double> seconds;
  double matches, mutual_matches;
};
const std::vector<std::string>& domain_algorithms();
const std::vector<DomainRow>& domains();

/// Table "Refinement Experiment" (Apollo-Southbay).
struct RefinementRow {
  std::string algorithm;
  double recall;               ///< %
  double te_cm[3], re_deg[3];  ///< mean, median, 95th percentile, over all pairs
};
const std::vector<RefinementRow>& refinement();

/// Table "Balanced registration set sizes".
struct SetSizes {
  std::string set;
  int train, validation, test;
};
const std::vector<SetSizes>& set_sizes();

}  // namespace loopmark::evaluation::paper
