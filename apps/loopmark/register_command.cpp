// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// loopmark register and loopmark replay: one pair of scans.

#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/register_run.hpp"

namespace loopmark::app {
namespace {

constexpr const char* kRegisterExamples = R"(
Examples:
  loopmark register a.pcd b.bin                               where does scan a stand in the frame of scan b?
  loopmark register a.pcd b.pcd --picture pair.png            with a picture, before and after
  loopmark register a.bin b.bin --algorithm ransac_gpf        the paper's pipeline instead of the engine
  loopmark register a.bin b.bin --record pair.rec --json      keep everything; loopmark replay pair.rec opens it again
The answer is T_target_source: it moves points of SOURCE into the frame of TARGET. Exit code 0 also when the verdict
is "unknown".
)";

constexpr const char* kReplayExamples = R"(
Examples:
  loopmark replay pair.rec                                    run the recorded registration again
  loopmark replay pair.rec --set registration.hypotheses=40   ... with another option
  loopmark replay pair.rec --picture pair.png
)";

struct Arguments {
  std::string source;
  std::string target;
  std::string folder;
  std::string algorithm = "engine";
  std::string descriptor;
  std::string picture;
  std::string record;
  bool json = false;
};

PointCloud read_scan_of_pair(const std::string& file, const io::LogOptions& options) {
  check(options);
  io::PointFile points = io::read_point_file(file, options);
  if (points.has_viewpoint) {
    log(Severity::kWarning, file +
                                ": its header has a VIEWPOINT that moves the points; it is not applied: the answer is "
                                "that of the points as they are stored");
  }
  return std::move(points.cloud);
}

void show(const workflows::RegisterRun& run, const Arguments& a) {
  std::fputs((a.json ? workflows::registration_json(run) : workflows::registration_text(run)).c_str(), stdout);
  if (!a.picture.empty()) {
    workflows::write_registration_picture(run, a.picture);
  }
}

int register_pair(const Arguments& a, const Globals& globals) {
  const workflows::ProgramOptions options = globals.options();
  workflows::RegisterRun run;
  run.source = read_scan_of_pair(a.source, options.log);
  run.target = read_scan_of_pair(a.target, options.log);
  run.source_name = a.source;
  run.target_name = a.target;
  run.algorithm = a.algorithm;
  run.descriptor = a.descriptor;
  workflows::run_registration(run, options);
  show(run, a);
  if (!a.record.empty()) {
    workflows::write_record(run, options, a.record);
  }
  return 0;
}

int replay(const Arguments& a, const Globals& globals) {
  workflows::Record record = workflows::read_record(a.folder);
  const registration::RegistrationResult before = record.run.result;
  if (!globals.config_file.empty() || !globals.settings.empty()) {
    record.options = globals.options();
  }
  workflows::run_registration(record.run, record.options);
  show(record.run, a);
  const PoseError change = pose_error(record.run.result.T_target_source, before.T_target_source);
  if (!a.json) {
    std::printf("recorded      P(correct) %.3f; the answer moved by %.4f m and %.4f deg\n", before.p_correct,
                change.translation_m, change.rotation_deg);
  }
  return 0;
}

}  // namespace

Action set_up_register(CLI::App& command, const Globals& globals) {
  auto a = std::make_shared<Arguments>();
  command.add_option("source", a->source, "scan that is moved: .bin, .pcd or .ply")->required();
  command.add_option("target", a->target, "scan in whose frame the answer stands")->required();
  command.add_option("--algorithm", a->algorithm,
                     "engine, a variant of the paper by name (ransac_gpf, gnc_clique, ...), or custom (section paper)");
  command.add_option(
      "--descriptor", a->descriptor,
      "of the paper's variants: fsc (the default), fpfh, or a folder of .npz files named like the scans");
  command.add_option("--picture", a->picture, "writes a PNG: before and after, from above and from the side");
  command.add_option("--record", a->record, "writes a folder that loopmark replay opens again");
  command.add_flag("--json", a->json, "prints JSON");
  command.footer(kRegisterExamples);
  return [a, &globals] { return register_pair(*a, globals); };
}

Action set_up_replay(CLI::App& command, const Globals& globals) {
  auto a = std::make_shared<Arguments>();
  command.add_option("record", a->folder, "folder written by loopmark register --record")->required();
  command.add_option("--picture", a->picture, "writes a PNG: before and after, from above and from the side");
  command.add_flag("--json", a->json, "prints JSON");
  command.footer(kReplayExamples);
  return [a, &globals] { return replay(*a, globals); };
}

}  // namespace loopmark::app
