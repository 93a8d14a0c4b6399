// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <nlohmann/json.hpp>

#include "outcome_json.hpp"

namespace loopmark::evaluation::internal {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json spread(const statistics::Spread& s) {
  return {{"mean", number(s.mean)}, {"median", number(s.median)}, {"p95", number(s.p95)}};
}

Json bins(const std::vector<RecallBin>& table) {
  Json rows = Json::array();
  for (const RecallBin& bin : table) {
    const statistics::Interval interval = statistics::wilson_interval(bin.successes, bin.pairs);
    rows.push_back({{"low", bin.low},
                    {"high", bin.high},
                    {"pairs", bin.pairs},
                    {"recall", bin.pairs ? Json(bin.recall()) : Json(nullptr)},
                    {"recall_low", interval.low},
                    {"recall_high", interval.high}});
  }
  return rows;
}

Json named(const std::vector<std::pair<std::string, double>>& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) {
    json[name] = number(value);
  }
  return json;
}

void add_certainty(Json& json, const AlgorithmSummary& s) {
  json["answered"] = s.answered;
  json["answered_wrong"] = s.answered_wrong;
  json["no_motion"] = s.failed;
  json["negatives"] = s.negatives;
  json["false_accepts"] = s.false_accepts;
  json["false_accept_rate"] = s.negatives ? Json(s.false_accept_rate()) : Json(nullptr);
  json["false_accept_low"] = s.false_accept_interval.low;
  json["false_accept_high"] = s.false_accept_interval.high;
  json["average_precision"] = s.has_scores ? number(s.average_precision) : Json(nullptr);
  json["expected_calibration_error"] = s.reliability.empty() ? Json(nullptr) : number(s.calibration_error);
  Json rows = Json::array();
  for (const statistics::ReliabilityBin& bin : s.reliability) {
    rows.push_back({{"low", bin.low},
                    {"high", bin.high},
                    {"count", bin.count},
                    {"mean_p", bin.mean_p},
                    {"share_correct", bin.share_correct}});
  }
  json["reliability"] = rows;
}

Json algorithm(const AlgorithmSummary& s) {
  Json json;
  json["name"] = s.name;
  json["pairs"] = s.pairs;
  json["successes"] = s.successes;
  json["recall"] = s.recall();
  json["recall_low"] = s.recall_interval.low;
  json["recall_high"] = s.recall_interval.high;
  json["te_median_m"] = number(s.te_m.median);
  json["re_median_deg"] = number(s.re_deg.median);
  json["seconds_median"] = number(s.total_seconds.median);
  json["paper_seconds_median"] = number(s.paper_seconds.median);
  json["te_m"] = spread(s.te_m);
  json["re_deg"] = spread(s.re_deg);
  json["te_median_low_m"] = number(s.te_median_interval_m.low);
  json["te_median_high_m"] = number(s.te_median_interval_m.high);
  json["re_median_low_deg"] = number(s.re_median_interval_deg.low);
  json["re_median_high_deg"] = number(s.re_median_interval_deg.high);
  json["te_of_successes_m"] = spread(s.te_success_m);
  json["re_of_successes_deg"] = spread(s.re_success_deg);
  json["seconds"] = spread(s.total_seconds);
  json["paper_seconds"] = spread(s.paper_seconds);
  json["stage_seconds_median"] = named(s.stage_medians_s);
  json["number_means"] = named(s.number_means);
  add_certainty(json, s);
  json["by_symmetric_overlap"] = bins(s.by_overlap);
  json["by_distance_m"] = bins(s.by_distance);
  json["by_abs_yaw_deg"] = bins(s.by_yaw);
  return json;
}

}  // namespace

std::string summary_to_json(const Experiment& experiment, const std::vector<AlgorithmSummary>& summaries,
                            const std::vector<PairedTest>& tests) {
  Json json;
  json["format"] = "loopmark evaluation 1";
  json["set"] = {{"name", experiment.set_name},
                 {"sha256", experiment.set_sha256},
                 {"pairs", experiment.pairs},
                 {"negatives", experiment.negatives}};
  json["criterion"] = {{"max_rotation_deg", experiment.criterion.max_rotation_deg},
                       {"max_translation_m", experiment.criterion.max_translation_m}};
  json["settings"] = experiment.settings;
  json["algorithms"] = Json::array();
  for (const AlgorithmSummary& summary : summaries) {
    json["algorithms"].push_back(algorithm(summary));
  }
  json["paired_tests"] = Json::array();
  for (const PairedTest& test : tests) {
    json["paired_tests"].push_back({{"first", test.first},
                                    {"second", test.second},
                                    {"both", test.both},
                                    {"only_first", test.only_first},
                                    {"only_second", test.only_second},
                                    {"neither", test.neither},
                                    {"mcnemar_p", test.p_value}});
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

}  // namespace loopmark::evaluation::internal
