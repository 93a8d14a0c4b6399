// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "outcome_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"

namespace loopmark::evaluation::internal {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
double number(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Json motion(const Pose& pose) {
  Json values = Json::array();
  for (int i = 0; i < 12; ++i) {
    values.push_back(pose.matrix()(i / 4, i % 4));
  }
  return values;
}

Pose motion(const Json& values) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < 12; ++i) {
    pose.matrix()(i / 4, i % 4) = values.at(static_cast<std::size_t>(i)).get<double>();
  }
  return pose;
}

/// Runs a parser; anything that nlohmann throws becomes an InputError.
template <class Parse>
auto parsed(const std::string& text, const std::string& file, const Parse& parse) {
  try {
    return parse(Json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, "", std::string("not the JSON that is expected here: ") + error.what());
  }
}

}  // namespace

std::string outcome_to_line(const Outcome& outcome) {
  Json json;
  json["algorithm"] = outcome.algorithm;
  json["pair"] = outcome.pair;
  json["negative"] = outcome.negative;
  json["status"] = to_string(outcome.answer.status);
  json["motion"] = motion(outcome.answer.T_target_source);
  json["p_correct"] = number(outcome.answer.p_correct);
  json["te_m"] = number(outcome.error.translation_m);
  json["re_deg"] = number(outcome.error.rotation_deg);
  json["success"] = outcome.success;
  json["note"] = outcome.answer.note;
  Json numbers = Json::object();
  for (const auto& [name, value] : outcome.answer.numbers) {
    numbers[name] = number(value);
  }
  json["numbers"] = numbers;
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::string times_to_line(const Outcome& outcome) {
  Json json;
  json["algorithm"] = outcome.algorithm;
  json["pair"] = outcome.pair;
  json["paper_seconds"] = number(outcome.answer.paper_seconds);
  json["total_seconds"] = number(outcome.answer.total_seconds);
  Json stages = Json::array();
  for (const registration::StageTime& stage : outcome.answer.timings) {
    stages.push_back({stage.stage, stage.seconds});
  }
  json["stages"] = stages;
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

Outcome outcome_from_line(const std::string& line, const std::string& file) {
  return parsed(line, file, [](const Json& json) {
    Outcome outcome;
    outcome.algorithm = json.at("algorithm").get<std::string>();
    outcome.pair = json.at("pair").get<std::size_t>();
    outcome.negative = json.at("negative").get<bool>();
    outcome.answer.status = answer_status_from(json.at("status").get<std::string>());
    outcome.answer.T_target_source = motion(json.at("motion"));
    outcome.answer.p_correct = number(json.at("p_correct"));
    outcome.error = {number(json.at("te_m")), number(json.at("re_deg"))};
    outcome.success = json.at("success").get<bool>();
    outcome.answer.note = json.at("note").get<std::string>();
    for (const auto& [name, value] : json.at("numbers").items()) {
      outcome.answer.numbers.emplace_back(name, number(value));
    }
    return outcome;
  });
}

Outcome times_from_line(const std::string& line, const std::string& file) {
  return parsed(line, file, [](const Json& json) {
    Outcome outcome;
    outcome.algorithm = json.at("algorithm").get<std::string>();
    outcome.pair = json.at("pair").get<std::size_t>();
    outcome.answer.paper_seconds = number(json.at("paper_seconds"));
    outcome.answer.total_seconds = number(json.at("total_seconds"));
    for (const Json& stage : json.at("stages")) {
      outcome.answer.timings.push_back({stage.at(0).get<std::string>(), stage.at(1).get<double>()});
    }
    return outcome;
  });
}

std::string experiment_to_json(const Experiment& experiment) {
  Json json;
  json["format"] = "loopmark experiment 1";
  json["set"] = experiment.set_name;
  json["set_sha256"] = experiment.set_sha256;
  json["extra_sha256"] = experiment.extra_sha256;
  json["pairs"] = experiment.pairs;
  json["negatives"] = experiment.negatives;
  json["max_rotation_deg"] = experiment.criterion.max_rotation_deg;
  json["max_translation_m"] = experiment.criterion.max_translation_m;
  json["algorithms"] = experiment.algorithms;
  json["settings"] = experiment.settings;
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

Experiment experiment_from_json(const std::string& text, const std::string& file) {
  return parsed(text, file, [&file](const Json& json) {
    Experiment experiment;
    experiment.set_name = json.at("set").get<std::string>();
    experiment.set_sha256 = json.at("set_sha256").get<std::string>();
    experiment.extra_sha256 = json.at("extra_sha256").get<std::string>();
    experiment.pairs = json.at("pairs").get<std::size_t>();
    experiment.negatives = json.at("negatives").get<std::size_t>();
    experiment.criterion = {json.at("max_rotation_deg").get<double>(), json.at("max_translation_m").get<double>()};
    experiment.algorithms = json.at("algorithms").get<std::vector<std::string>>();
    experiment.settings = json.at("settings").get<std::vector<std::string>>();
    if (experiment.settings.size() != experiment.algorithms.size()) {
      throw InputError(file, "settings", "there are not as many as algorithms", "copy the folder again");
    }
    check(experiment.criterion);
    return experiment;
  });
}

}  // namespace loopmark::evaluation::internal
