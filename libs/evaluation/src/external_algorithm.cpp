// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/external_algorithm.hpp"

#include <unistd.h>

#include <atomic>
#include <mutex>
#include <sstream>
#include <stdexcept>

#include "child_process.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::evaluation {
namespace {

namespace fs = std::filesystem;
using internal::ChildProcess;

constexpr const char* kGreeting = "loopmark-registration 1";

std::string shortened(const std::string& text) { return text.size() > 60 ? text.substr(0, 60) + "..." : text; }

Answer failure(AnswerStatus status, const std::string& note) {
  Answer answer;
  answer.status = status;
  answer.note = note;
  return answer;
}

Answer nonsense(const std::string& line, const std::string& why) {
  return failure(AnswerStatus::kCrashed, "answered nonsense (" + why + "): '" + shortened(line) + "'");
}

/// "motion m0 ... m15 SCORE SECONDS" or "failed REASON".
Answer parse_answer(const std::string& line) {
  if (line.rfind("failed", 0) == 0) {
    return failure(AnswerStatus::kFailed, line.size() > 7 ? shortened(line.substr(7)) : "the program gave no reason");
  }
  std::istringstream words(line);
  std::string word;
  words >> word;
  if (word != "motion") {
    return nonsense(line, "neither motion nor failed");
  }
  std::vector<double> values;
  while (words >> word) {
    const std::optional<double> value = number_in(word);
    if (!value) {
      return nonsense(line, "'" + word + "' is no number");
    }
    values.push_back(*value);
  }
  if (values.size() != 18) {
    return nonsense(line, std::to_string(values.size()) + " numbers where 18 are expected");
  }
  Answer answer;
  try {
    answer.T_target_source =
        rigid_from_matrix(Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data()), 1e-2);
  } catch (const std::invalid_argument& error) {
    return nonsense(line, error.what());
  }
  answer.p_correct = values[16];
  answer.paper_seconds = values[17];
  return answer;
}

class ExternalAlgorithm : public RegistrationAlgorithm {
 public:
  ExternalAlgorithm(std::string name, const ExternalOptions& options) : name_(std::move(name)), options_(options) {
    const fs::path base = options.scratch.empty() ? fs::temp_directory_path() : options.scratch;
    if (base.string().find(' ') != std::string::npos) {
      throw InputError(base.string(), "", "a space in the folder for the clouds", "set TMPDIR to one without");
    }
    scratch_ = storage::make_private_folder(base, "loopmark-pairs-");
    try {
      idle_.push_back(start());
    } catch (...) {
      fs::remove_all(scratch_);
      throw;
    }
  }

  ~ExternalAlgorithm() override {
    for (const auto& process : idle_) {
      process->write_line("quit");
    }
    idle_.clear();
    std::error_code ignored;
    fs::remove_all(scratch_, ignored);
  }

  const std::string& name() const override { return name_; }
  std::string settings() const override {
    return options_.command + " (time limit " + format_text("%f", options_.time_limit_s) + " s)";
  }

  Answer answer(const PairTask& task) override {
    const fs::path source = scratch_ / (std::to_string(task.index) + "-source.bin");
    const fs::path target = scratch_ / (std::to_string(task.index) + "-target.bin");
    io::write_bin(source, task.scans->source());
    io::write_bin(target, task.scans->target());
    Answer answer;
    try {
      answer = ask("pair " + source.string() + " " + target.string());
    } catch (const InputError& error) {
      answer = failure(AnswerStatus::kCrashed, error.what());
    }
    fs::remove(source);
    fs::remove(target);
    return answer;
  }

 private:
  std::unique_ptr<internal::ChildProcess> start() const {
    auto process = std::make_unique<internal::ChildProcess>(options_.command);
    std::string line;
    const bool listens = process->write_line(kGreeting);
    const internal::ChildProcess::Read read = process->read_line(line, options_.start_limit_s);
    if (!listens || read != internal::ChildProcess::Read::kLine || line.rfind("ready", 0) != 0) {
      const std::string what = read == internal::ChildProcess::Read::kTimeLimit ? "said nothing"
                               : read == internal::ChildProcess::Read::kLine    ? "said '" + shortened(line) + "'"
                                                                                : "ended (" + process->stop() + ")";
      throw InputError("the program '" + options_.command + "' " + what + " where 'ready' was expected", "",
                       "it must speak the protocol of docs/guide/evaluation.md");
    }
    return process;
  }

  std::unique_ptr<internal::ChildProcess> take() {
    {
      const std::scoped_lock lock(mutex_);
      if (!idle_.empty()) {
        auto process = std::move(idle_.back());
        idle_.pop_back();
        return process;
      }
    }
    return start();
  }

  Answer ask(const std::string& request) {
    std::unique_ptr<internal::ChildProcess> process = take();
    const Stopwatch watch;
    std::string line;
    const bool listens = process->write_line(request);
    const internal::ChildProcess::Read read = process->read_line(line, options_.time_limit_s);
    const double seconds = watch.seconds();
    Answer answer;
    if (!listens || read == internal::ChildProcess::Read::kEnded) {
      answer = failure(AnswerStatus::kCrashed, "the program ended (" + process->stop() + ")");
    } else if (read == internal::ChildProcess::Read::kTimeLimit) {
      answer = failure(AnswerStatus::kTimeLimit, "no answer within the time limit");
    } else {
      answer = parse_answer(line);
    }
    answer.total_seconds = seconds;
    if (answer.status == AnswerStatus::kAnswered || answer.status == AnswerStatus::kFailed) {
      const std::scoped_lock lock(mutex_);
      idle_.push_back(std::move(process));
    }
    return answer;
  }

  std::string name_;
  ExternalOptions options_;
  fs::path scratch_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<internal::ChildProcess>> idle_;
};

}  // namespace

std::unique_ptr<RegistrationAlgorithm> make_external_algorithm(std::string name, const ExternalOptions& options) {
  return std::make_unique<ExternalAlgorithm>(std::move(name), options);
}

}  // namespace loopmark::evaluation
