// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What an engineer who links the installed package can do: map a log, find its scans in the map, and evaluate a pair
// with a registration of his own.
#include <iostream>

#include "loopmark/evaluation/pair_algorithm.hpp"
#include "loopmark/workflows/map_job.hpp"
#include "loopmark/workflows/relocalize_log.hpp"

using namespace loopmark;

/// Believes that the two scans are where one sensor stood, and lets the engine judge that.
class StandingStill : public registration::PairRegistration {
 public:
  const std::string& name() const override { return name_; }
  registration::PreparedCloudPtr prepare(const PointCloud& cloud) const override { return engine_->prepare(cloud); }
  registration::PreparedCloudPtr restore(const std::string& bytes) const override { return engine_->restore(bytes); }
  registration::RegistrationResult align(const registration::PreparedCloud& source,
                                         const registration::PreparedCloud& target) const override {
    return engine_->verify(source, target, Pose::Identity());
  }
  registration::RegistrationResult verify(const registration::PreparedCloud& source,
                                          const registration::PreparedCloud& target, const Pose& T) const override {
    return engine_->verify(source, target, T);
  }

 private:
  std::string name_ = "standing_still";
  registration::PairRegistrationPtr engine_ = registration::engine_registration({});
};

int main(int argc, char** argv) try {
  const std::filesystem::path work = argc > 1 ? argv[1] : ".";
  const workflows::ProgramOptions options;
  const auto map = workflows::start_map(work / "log", {}, work / "run", {}, options);
  std::cout << "mapped " << map.summary.scans << " scans, " << map.summary.keyframes << " keyframes\n";

  const auto found = workflows::relocalize_log({.run = work / "run", .log = work / "log", .every = 5}, options);
  std::cout << "placed " << found.summary.answered << " of " << found.summary.scans << "\n";

  const auto log = io::open_log(work / "log", options.log);
  evaluation::PairScans scans(log->read(1).cloud, log->read(0).cloud);
  const auto algorithm = evaluation::make_pair_algorithm(std::make_shared<StandingStill>(), "");
  evaluation::PairTask task;
  task.scans = &scans;
  std::cout << algorithm->name() << ": P(correct) " << algorithm->answer(task).p_correct << "\n";
  return map.summary.scans > 0 && found.summary.answered > 0 ? 0 : 1;
} catch (const std::exception& problem) {
  std::cerr << problem.what() << "\n";
  return 2;
}
