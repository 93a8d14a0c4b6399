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
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"
#include "loopmark/feature_registration/pipeline.hpp"
#include "loopmark/features/descriptor_file.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/registration/evidence_text.hpp"
#include "loopmark/report/picture.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::workflows {
namespace {

using Json = nlohmann::ordered_json;

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

/// What `loopmark describe` or a network wrote for a scan.
feature_registration::DescribedScan from_file(const RegisterRun& run, const std::string& scan, const PointCloud& cloud,
                                              const feature_registration::FeatureRegistrationOptions& options) {
  const std::filesystem::path file =
      std::filesystem::path(run.descriptor) / std::filesystem::path(scan).stem().concat(".npz");
  features::DescriptorFile described = features::read_descriptors(file);
  return feature_registration::described_scan(std::move(described.points), std::move(described.descriptors), cloud,
                                              options);
}

feature_registration::FeatureRegistrationResult register_from_files(
    const RegisterRun& run, const feature_registration::FeatureRegistrationOptions& options) {
  const auto source = from_file(run, run.source_name, run.source, options);
  const auto target = from_file(run, run.target_name, run.target, options);
  feature_registration::require_comparable(source, "the source " + run.source_name, target,
                                           "the target " + run.target_name);
  return feature_registration::register_described(source, target, options);
}

/// The paper's variants answer without a probability: they never abstain unless they found nothing.
registration::RegistrationResult run_paper(const RegisterRun& run,
                                           feature_registration::FeatureRegistrationOptions options) {
  const bool files = std::filesystem::is_directory(run.descriptor);
  if (!files && !run.descriptor.empty()) {
    options.descriptor = run.descriptor;
  }
  const feature_registration::FeatureRegistrationResult paper =
      files ? register_from_files(run, options)
            : feature_registration::register_features(run.source, run.target, options);
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

/// The motion of a record: the answer, else the best guess that was withheld, else none.
std::vector<double> recorded_motion(const Json& json) {
  if (!json.at("T_target_source").is_null()) {
    return json.at("T_target_source").get<std::vector<double>>();
  }
  if (!json.at("modes").empty()) {
    return json.at("modes").at(0).at("T_target_source").get<std::vector<double>>();
  }
  return row_major(Pose::Identity().matrix());
}

std::string matrix_text(const Pose& pose) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    text += format_text("  %12.6f %12.6f %12.6f %12.4f\n", pose.matrix()(row, 0), pose.matrix()(row, 1),
                        pose.matrix()(row, 2), pose.matrix()(row, 3));
  }
  return text;
}

}  // namespace

void run_registration(RegisterRun& run, const ProgramOptions& options) {
  if (run.algorithm == "engine") {
    if (!run.descriptor.empty()) {
      throw InputError("--descriptor " + run.descriptor +
                       ": the engine has its own; name a variant of the paper, for example --algorithm ransac_gpf");
    }
    run.result = run_engine(run, options.registration);
  } else {
    run.result = run_paper(
        run, run.algorithm == "custom" ? options.paper : feature_registration::named_algorithm(run.algorithm));
  }
}

namespace {

std::string motion_text(const Pose& T_target_source) {
  const Eigen::Vector3d t = T_target_source.translation();
  const Eigen::Vector3d angles = euler_degrees(T_target_source.linear());
  return matrix_text(T_target_source) + format_text("translation   %.3f %.3f %.3f m\n", t.x(), t.y(), t.z()) +
         format_text("roll pitch yaw %.3f %.3f %.3f deg\n", angles.x(), angles.y(), angles.z());
}

/// An answer that was withheld does not look like one: no matrix, and what was found under another name.
std::string unknown_text(const RegisterRun& run) {
  const registration::RegistrationResult& r = run.result;
  std::string text = "UNKNOWN: where " + run.source_name + " stands in " + run.target_name + " cannot be told (" +
                     run.algorithm + ")\nreason        " + r.reason + "\n";
  if (run.algorithm == "engine") {
    text += format_text("P(correct)    %.3f for the best guess, too little to answer (registration.min_p_correct)\n",
                        r.p_correct);
  }
  return text;
}

std::string modes_text(const std::vector<registration::RegistrationMode>& modes) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(modes.size(), kShown); ++i) {
    const Eigen::Vector3d at = modes[i].T_target_source.translation();
    text += "mode " + std::to_string(i + 1) + format_text("        P %.3f", modes[i].p_correct) +
            format_text(", source at %.1f %.1f %.1f m", at.x(), at.y(), at.z()) +
            format_text(", yaw %.1f deg", euler_degrees(modes[i].T_target_source.linear()).z()) + " (" +
            modes[i].origin + ")\n";
  }
  return text + registration::evidence_table(modes, kShown);
}

}  // namespace

std::string registration_text(const RegisterRun& run) {
  const registration::RegistrationResult& r = run.result;
  std::string text;
  if (r.answered) {
    text = "T_target_source of " + run.source_name + " in " + run.target_name + " (" + run.algorithm + ")\n" +
           motion_text(r.T_target_source) + "verdict       answered";
    if (run.algorithm == "engine") {
      text += format_text(", P(correct) %.3f\nuncertainty   %.3f m", r.p_correct,
                          std::sqrt(r.covariance.topLeftCorner<3, 3>().trace()));
    }
    text += "\n";
  } else {
    text = unknown_text(run);
  }
  text += modes_text(r.modes) + "seconds      ";
  for (const registration::StageTime& stage : r.timings) {
    text += " " + stage.stage + format_text(" %.3f", stage.seconds);
  }
  return text + "\n";
}

std::string registration_json(const RegisterRun& run) {
  const registration::RegistrationResult& r = run.result;
  Json json = {{"source", run.source_name},
               {"target", run.target_name},
               {"algorithm", run.algorithm},
               {"descriptor", run.descriptor},
               {"T_target_source", r.answered ? Json(row_major(r.T_target_source.matrix())) : Json()},
               {"answered", r.answered},
               {"reason", r.reason},
               {"p_correct", r.p_correct},
               {"covariance", row_major(r.covariance)},
               {"modes", Json::array()},
               {"seconds", Json::object()}};
  for (const registration::RegistrationMode& mode : r.modes) {
    json["modes"].push_back(mode_json(mode));
  }
  for (const registration::StageTime& stage : r.timings) {
    json["seconds"][stage.stage] = stage.seconds;
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
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
    record.run.descriptor = json.value("descriptor", "");
    record.run.result.p_correct = json.at("p_correct");
    record.run.result.answered = json.at("answered");
    const std::vector<double> motion = recorded_motion(json);
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
