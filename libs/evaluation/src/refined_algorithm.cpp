// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "loopmark/core/error.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/evaluation/algorithm.hpp"
#include "loopmark/features/normals.hpp"
#include "loopmark/refinement/icp.hpp"

namespace loopmark::evaluation {
namespace {

struct Method {
  std::string name;
  refinement::IcpOptions options;
};

/// The refinements on offer; 0.3 m clouds, pairs up to 0.6 m, 30 iterations (paper, appendix "Local Registration").
const std::vector<Method>& methods() {
  static const std::vector<Method> table = [] {
    refinement::IcpOptions point;
    refinement::IcpOptions symmetric;
    symmetric.metric = refinement::IcpMetric::kSymmetric;
    refinement::IcpOptions buddies;
    buddies.pairing = refinement::IcpPairing::kBestBuddies;
    refinement::IcpOptions plane;
    plane.metric = refinement::IcpMetric::kPointToPlane;
    refinement::IcpOptions generalized;
    generalized.metric = refinement::IcpMetric::kGeneralized;
    return std::vector<Method>{
        {"icp", point}, {"sym-icp", symmetric}, {"bbr", buddies}, {"plane-icp", plane}, {"gicp", generalized}};
  }();
  return table;
}

/// A target made ready for searching, once a pair for all that refine alike, and what that took.
struct ReadyTarget {
  refinement::IcpTarget target;
  double seconds = 0.0;
};

class RefinedAlgorithm : public RegistrationAlgorithm {
 public:
  RefinedAlgorithm(std::string base, const Method& method)
      : base_(std::move(base)), method_(method), name_(base_ + "+" + method.name) {}

  const std::string& name() const override { return name_; }
  std::string settings() const override { return "refines " + base_ + " by " + method_.name; }

  Answer answer(const PairTask& task) override {
    Answer answer = task.earlier->at(base_);
    if (!answer.has_motion()) {
      return answer;
    }
    const bool normals = method_.options.metric != refinement::IcpMetric::kPointToPoint;
    const refinement::Surface& source = surface(*task.scans, "source", task.scans->small_source(), normals);
    const ReadyTarget& target = ready_target(*task.scans, normals);
    const Stopwatch watch;
    const refinement::IcpResult result =
        refinement::icp(source, target.target, answer.T_target_source, method_.options);
    const double seconds = target.seconds + watch.seconds();
    answer.T_target_source = result.T_target_source;
    answer.numbers.emplace_back("refined_inlier_share", result.inlier_share);
    answer.numbers.emplace_back("refinement_iterations", static_cast<double>(result.iterations));
    answer.timings.push_back({method_.name, seconds});
    answer.paper_seconds += seconds;
    answer.total_seconds += seconds;
    return answer;
  }

 private:
  const ReadyTarget& ready_target(PairScans& scans, bool normals) const {
    const refinement::Surface& target = surface(scans, "target", scans.small_target(), normals);
    const double distance = method_.options.max_distance_m;
    return scans.shared<ReadyTarget>(
        "icp target" + std::string(normals ? ", normals, " : ", ") + std::to_string(distance), [&] {
          const Stopwatch watch;
          refinement::IcpTarget ready(target, distance);
          return ReadyTarget{std::move(ready), watch.seconds()};
        });
  }

  static const refinement::Surface& surface(PairScans& scans, const std::string& which, const PointCloud& cloud,
                                            bool normals) {
    return scans.shared<refinement::Surface>("surface of " + which + (normals ? " with normals" : ""), [&] {
      return refinement::Surface{cloud.points, normals ? features::estimate_normals(cloud.points, {}).vectors
                                                       : std::vector<Eigen::Vector3f>()};
    });
  }

  std::string base_;
  Method method_;
  std::string name_;
};

}  // namespace

std::vector<std::string> refinement_methods() {
  std::vector<std::string> names;
  for (const Method& method : methods()) {
    names.push_back(method.name);
  }
  return names;
}

std::unique_ptr<RegistrationAlgorithm> make_refined_algorithm(const std::string& base, const std::string& name) {
  const auto method = std::find_if(methods().begin(), methods().end(), [&](const Method& m) { return m.name == name; });
  if (method == methods().end()) {
    std::string known;
    for (const std::string& other : refinement_methods()) {
      known += (known.empty() ? "" : ", ") + other;
    }
    throw InputError("--refine " + name + ": no such refinement (there are: " + known + ")");
  }
  return std::make_unique<RefinedAlgorithm>(base, *method);
}

}  // namespace loopmark::evaluation
