// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "peer_algorithms.hpp"

#include "loopmark/core/progress.hpp"

namespace loopmark::benchmarks {
namespace {

/// A scan as the library has made it, and what that took.
struct Prepared {
  PeerLibrary::Scan scan;
  double seconds = 0.0;
};

class Peer : public evaluation::RegistrationAlgorithm {
 public:
  Peer(PeerLibrary library, std::string name) : library_(std::move(library)), name_(std::move(name)) {}

  const std::string& name() const override { return name_; }
  std::string settings() const override { return name_ + " of " + library_.name; }

 protected:
  const Prepared& prepared(const evaluation::PairTask& task, bool source) const {
    return task.scans->shared<Prepared>(library_.name + (source ? " source" : " target"), [&] {
      const Stopwatch watch;
      PeerLibrary::Scan scan = library_.prepare(finite(source ? task.scans->source() : task.scans->target()));
      return Prepared{std::move(scan), watch.seconds()};
    });
  }

 private:
  static std::vector<Eigen::Vector3f> finite(const PointCloud& cloud) {
    std::vector<Eigen::Vector3f> points;
    std::copy_if(cloud.points.begin(), cloud.points.end(), std::back_inserter(points),
                 [](const Eigen::Vector3f& p) { return p.allFinite(); });
    return points;
  }

  PeerLibrary library_;
  std::string name_;
};

class Finder : public Peer {
 public:
  Finder(const PeerLibrary& library, const PeerLibrary::Finder& finder) : Peer(library, finder.name), finder_(finder) {}

  evaluation::Answer answer(const evaluation::PairTask& task) override {
    const Prepared& source = prepared(task, true);
    const Prepared& target = prepared(task, false);
    const Stopwatch watch;
    const std::optional<Pose> found = finder_.find(source.scan.get(), target.scan.get());
    evaluation::Answer answer;
    answer.status = found ? evaluation::AnswerStatus::kAnswered : evaluation::AnswerStatus::kFailed;
    answer.T_target_source = found.value_or(Pose::Identity());
    answer.timings = {{"prepare both scans", source.seconds + target.seconds}, {"find", watch.seconds()}};
    answer.paper_seconds = answer.timings[1].seconds;
    answer.total_seconds = answer.timings[0].seconds + answer.timings[1].seconds;
    return answer;
  }

 private:
  PeerLibrary::Finder finder_;
};

class Refiner : public Peer {
 public:
  Refiner(const PeerLibrary& library, const std::string& base, const PeerLibrary::Refiner& refiner)
      : Peer(library, base + "+" + refiner.name), base_(base), refiner_(refiner) {}

  evaluation::Answer answer(const evaluation::PairTask& task) override {
    evaluation::Answer answer = task.earlier->at(base_);
    if (answer.has_motion()) {
      const Prepared& source = prepared(task, true);
      const Prepared& target = prepared(task, false);
      const Stopwatch watch;
      answer.T_target_source = refiner_.refine(source.scan.get(), target.scan.get(), answer.T_target_source);
      answer.timings.push_back({refiner_.name, watch.seconds()});
      answer.paper_seconds += answer.timings.back().seconds;
      answer.total_seconds += answer.timings.back().seconds;
    }
    return answer;
  }

 private:
  std::string base_;
  PeerLibrary::Refiner refiner_;
};

}  // namespace

void add_peers(evaluation::AlgorithmList& list, const PeerLibrary& library) {
  for (const PeerLibrary::Finder& finder : library.finders) {
    list.push_back(std::make_unique<Finder>(library, finder));
    for (const PeerLibrary::Refiner& refiner : library.refiners) {
      list.push_back(std::make_unique<Refiner>(library, finder.name, refiner));
    }
  }
}

}  // namespace loopmark::benchmarks
