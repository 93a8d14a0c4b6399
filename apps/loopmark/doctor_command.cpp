// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/io/log_formats.hpp"
#include "loopmark/io/log_report.hpp"
#include "loopmark/workflows/compensation_of_log.hpp"

namespace loopmark::app {
namespace {

struct DoctorArguments {
  std::filesystem::path path;
  std::filesystem::path sessions;
  bool json = false;
};

constexpr const char* kExamples = R"(Examples:
  loopmark doctor drives/day1                       what the log is, what is wrong with it, what to run next
  loopmark doctor my.bag                            topics, which one would be taken, and what its points' times mean
  loopmark doctor drives/day1.rawlog --json         the same for programs
  loopmark doctor /data/nuscenes                    the drives of a data set: what is there, what is missing
  loopmark doctor logs --sessions set/sessions.txt  the logs that a set of pairs names
Nothing is written.)";

int doctor_of_log(const io::DriveLog& log, bool json) {
  io::LogReport report = io::examine_log(log);
  report.frame_problem = workflows::frame_problem_of_log(log);
  report.compensation = workflows::describe_measurement(workflows::compensation_of_log(log));
  std::fputs((json ? io::report_json(report) : io::report_text(report)).c_str(), stdout);
  return report.usable > 0 ? 0 : static_cast<int>(ExitCode::kInput);
}

int doctor_of_dataset(const io::Dataset& dataset, bool json) {
  const io::DatasetReport report = io::examine_dataset(dataset);
  std::fputs((json ? io::report_json(report) : io::report_text(report)).c_str(), stdout);
  return 0;
}

/// The data set under a root folder that is no log itself; the log's error when it is neither.
std::unique_ptr<io::Dataset> dataset_instead(const std::filesystem::path& path, const io::DatasetOptions& options,
                                             const InputError& log_error) {
  try {
    return io::open_dataset(path, {}, options);
  } catch (const InputError& error) {
    const bool no_dataset = std::string(error.what()).find("no data set") != std::string::npos ||
                            std::string(error.what()).find("no such folder") != std::string::npos;
    throw no_dataset ? log_error : error;
  }
}

int doctor(const DoctorArguments& arguments, const io::DatasetOptions& options) {
  if (!arguments.sessions.empty()) {
    return doctor_of_dataset(*io::open_dataset(arguments.path, arguments.sessions, options), arguments.json);
  }
  std::unique_ptr<io::DriveLog> log;
  try {
    log = io::open_log(arguments.path, options.log);
  } catch (const InputError& error) {
    return doctor_of_dataset(*dataset_instead(arguments.path, options, error), arguments.json);
  }
  return doctor_of_log(*log, arguments.json);
}

}  // namespace

Action set_up_doctor(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<DoctorArguments>();
  command.add_option("LOG", arguments->path, "drive log of any format, or root folder of a data set")->required();
  command.add_option("--sessions", arguments->sessions, "file that names the log below LOG of each session number");
  command.add_flag("--json", arguments->json, "answer as JSON");
  command.footer(std::string(kExamples) + "\nDrive logs are:\n" + io::log_formats_text());
  return [arguments, &globals] {
    const workflows::ProgramOptions all = globals.options();
    io::DatasetOptions options = all.dataset;
    options.log = all.log;
    return doctor(*arguments, options);
  };
}

}  // namespace loopmark::app
