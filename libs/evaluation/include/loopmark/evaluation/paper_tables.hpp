// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The paper's tables, filled with our results, theirs beside.
#pragma once

#include <string>
#include <vector>

#include "loopmark/evaluation/result_folder.hpp"
#include "loopmark/text/text_table.hpp"

namespace loopmark::evaluation {

/// A result with the names of the set it was tested on and of the set its features were trained on.
struct DomainResult {
  std::string test, train;
  StoredResult result;
};

/// One result for each train domain: algorithms VARIANT@TRAIN (descriptors of that domain) become VARIANT of TRAIN;
/// those without stay together under `train`.
std::vector<DomainResult> split_by_domain(const std::string& test, const std::string& train,
                                          const StoredResult& result);

/// Recall and mean seconds of each algorithm alone and with ICP ("Evaluation of Registration Algorithms"; cross:
/// "Cross-Domain Evaluation"). An algorithm X stands in one row with X+icp.
text::TextTable paper_evaluation_table(const StoredResult& result, bool cross);

/// Recall of every algorithm for every test and train domain ("All Registration Sets Cross-Domain").
text::TextTable paper_matrix_table(const std::vector<DomainResult>& results);
/// Mean seconds, the same layout ("Running Times").
text::TextTable paper_times_table(const std::vector<DomainResult>& results);
/// Mean number of matches before and after the mutual check ("Pair-Match Set Sizes").
text::TextTable paper_match_sizes_table(const std::vector<DomainResult>& results);

/// Recall, TE and RE (mean, median, 95 %) of refinements ("Refinement Experiment").
text::TextTable paper_refinement_table(const StoredResult& result);

/// Sizes and difficulty of sets ("Balanced registration set sizes", Fig. "Challenging registration sets").
text::TextTable paper_sets_table(
    const std::vector<std::pair<std::string, std::vector<pair_sets::RegistrationPair>>>& sets);

/// One run of a repeated experiment in the plane of time and recall.
struct RunPoint {
  double seconds = 0.0;  ///< mean, the paper's accounting
  double recall = 0.0;   ///< share
};

/// All repeats of one variant: algorithms whose names agree up to "#N".
struct Variant {
  std::string name;
  std::vector<RunPoint> runs;
  RunPoint mean;
  std::vector<RunPoint> hull;  ///< convex hull, counter-clockwise
};
std::vector<Variant> variants_of(const StoredResult& result);

/// Convex hull of points in the plane, counter-clockwise, without points on its edges (Andrew's monotone chain).
std::vector<RunPoint> convex_hull(std::vector<RunPoint> points);

/// Mean, spread and hull of every variant (figures "RANSAC Ablation" and "GPF Ablation").
text::TextTable paper_ablation_table(const StoredResult& result);

/// Success and failure of one algorithm in the bins of one quantity (figure "Analysis of Failures").
struct FailureHistogram {
  std::string quantity;
  std::vector<double> edges;
  std::vector<std::size_t> successes, failures;
};
std::vector<FailureHistogram> failure_histograms(const StoredResult& result, const std::string& algorithm);
text::TextTable paper_failures_table(const StoredResult& result, const std::string& algorithm);

}  // namespace loopmark::evaluation
