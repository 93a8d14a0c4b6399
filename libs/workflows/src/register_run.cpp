// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/register_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/config/options_io.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"
#include "loopmark/feature_registration/pipeline.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/report/picture.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::workflows {
namespace {

using Json = nlohmann::ordered_json;

std::string formatted(const char* format, double a, double b = 0.0, double c = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

template <class Matrix>
std::vector<double> row_major(const Matrix& matrix) {
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      numbers.push_back(matrix(row, column));
    }
  }
  return numbers;
}

Json mode_json(const registration::RegistrationMode& mode) {
  Json evidence;
  for (const auto& [name, value] : mode.evidence) {
    evidence[name] = value;
  }
  return {{"T_target_source", row_major(mode.T_target_source.matrix())},
          {"p_correct", mode.p_correct},
          {"origin", mode.origin},
          {"evidence", evidence}};
}

/// The paper's variants answer without a probability: they never abstain unless they found nothing.
registration::RegistrationResult run_paper(const RegisterRun& run,
                                           const feature_registration::FeatureRegistrationOptions& options) {
  const feature_registration::FeatureRegistrationResult paper =
      feature_registration::register_features(run.source, run.target, options);
  registration::RegistrationResult result;
  result.T_target_source = paper.T_target_source;
  result.answered = paper.found;
  result.reason = paper.found ? "" : "the estimator found no motion";
  result.timings = paper.timings;
  return result;
}

registration::RegistrationResult run_engine(const RegisterRun& run, const registration::EngineOptions& options) {
  Stopwatch watch;
  const registration::PreparedScan source = registration::prepare_scan(run.source, options);
  const registration::PreparedScan target = registration::prepare_scan(run.target, options);
  const double seconds = watch.seconds();
  registration::RegistrationResult result = registration::register_scans(source, target, options);
  result.timings.insert(result.timings.begin(), {"prepare both scans", seconds});
  return result;
}

std::string matrix_text(const Pose& pose) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    char line[128];
    std::snprintf(line, sizeof line, "  %12.6f %12.6f %12.6f %12.4f\n", pose.matrix()(row, 0), pose.matrix()(row, 1),
                  pose.matrix()(row, 2), pose.matrix()(row, 3));
    text += line;
  }
  return text;
}

}  // namespace

void run_registration(RegisterRun& run, const ProgramOptions& options) {
  if (run.algorithm == "engine") {
    run.result = run_engine(run, options.registration);
  } else {
    run.result = run_paper(
        run, run.algorithm == "custom" ? options.paper : feature_registration::named_algorithm(run.algorithm));
  }
}

std::string registration_text(const RegisterRun& run) {
  const registration::RegistrationResult& r = run.result;
  const Eigen::Vector3d t = r.T_target_source.translation();
  const Eigen::Vector3d angles = euler_degrees(r.T_target_source.linear());
  std::string text = "T_target_source of " + run.source_name + " in " + run.target_name + " (" + run.algorithm + ")\n" +
                     matrix_text(r.T_target_source);
  text += formatted("translation   %.3f %.3f %.3f m\n", t.x(), t.y(), t.z());
  text += formatted("roll pitch yaw %.3f %.3f %.3f deg\n", angles.x(), angles.y(), angles.z());
  text += r.answered ? "verdict       answered" : "verdict       UNKNOWN: " + r.reason;
  if (run.algorithm == "engine") {
    text += formatted(", P(correct) %.3f", r.p_correct);
    text += formatted("\nuncertainty   %.3f m", std::sqrt(r.covariance.topLeftCorner<3, 3>().trace()));
    for (std::size_t i = 0; i < std::min<std::size_t>(r.modes.size(), 3); ++i) {
      const Eigen::Vector3d at = r.modes[i].T_target_source.translation();
      text += "\nmode " + std::to_string(i + 1) +
              formatted("  P %.3f at %.1f %.1f m ", r.modes[i].p_correct, at.x(), at.y());
      for (const auto& [name, value] : r.modes[i].evidence) {
        text += " " + name + formatted(" %.3g", value);
      }
    }
  }
  text += "\nseconds      ";
  for (const registration::StageTime& stage : r.timings) {
    text += " " + stage.stage + formatted(" %.3f", stage.seconds);
  }
  return text + "\n";
}

std::string registration_json(const RegisterRun& run) {
  const registration::RegistrationResult& r = run.result;
  Json json = {{"source", run.source_name},  {"target", run.target_name},
               {"algorithm", run.algorithm}, {"T_target_source", row_major(r.T_target_source.matrix())},
               {"answered", r.answered},     {"reason", r.reason},
               {"p_correct", r.p_correct},   {"covariance", row_major(r.covariance)},
               {"modes", Json::array()},     {"seconds", Json::object()}};
  for (const registration::RegistrationMode& mode : r.modes) {
    json["modes"].push_back(mode_json(mode));
  }
  for (const registration::StageTime& stage : r.timings) {
    json["seconds"][stage.stage] = stage.seconds;
  }
  return json.dump(2) + "\n";
}

void write_registration_picture(const RegisterRun& run, const std::filesystem::path& path) {
  const auto thin = [](const PointCloud& cloud) { return cloud::voxel_downsampled(cloud, 0.2).points; };
  report::write_png(path, report::registration_picture(thin(run.source), thin(run.target), run.result.T_target_source));
}

void write_record(const RegisterRun& run, const ProgramOptions& options, const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder)) {
    throw InputError(folder.string(), "", "exists already", "name a new folder for the record");
  }
  const std::filesystem::path partial = folder.string() + ".partial";
  std::filesystem::remove_all(partial);
  std::error_code error;
  if (!std::filesystem::create_directories(partial, error)) {
    throw InputError(partial.string(), "", "cannot make the folder: " + error.message());
  }
  io::write_bin(partial / "source.bin", run.source);
  io::write_bin(partial / "target.bin", run.target);
  storage::write_file_atomically(partial / "options.yaml", config::dump(options));
  storage::write_file_atomically(partial / "result.json", registration_json(run));
  std::filesystem::rename(partial, folder);
}

Record read_record(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "result.json";
  Record record;
  record.options = config::load<ProgramOptions>(folder / "options.yaml", {});
  record.run.source = io::read_point_file(folder / "source.bin").cloud;
  record.run.target = io::read_point_file(folder / "target.bin").cloud;
  try {
    const Json json = Json::parse(storage::read_file(file));
    record.run.source_name = json.at("source");
    record.run.target_name = json.at("target");
    record.run.algorithm = json.at("algorithm");
    record.run.result.p_correct = json.at("p_correct");
    record.run.result.answered = json.at("answered");
    const std::vector<double> motion = json.at("T_target_source");
    for (std::size_t i = 0; i < 16; ++i) {
      record.run.result.T_target_source.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
          motion.at(i);
    }
  } catch (const std::exception& problem) {
    throw InputError(file.string(), "", std::string("is no record of a registration: ") + problem.what(),
                     "make one with loopmark register --record");
  }
  return record;
}

}  // namespace loopmark::workflows
