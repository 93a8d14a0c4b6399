// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/feature_registration/feature_registration.hpp"

#include <stdexcept>

#include "loopmark/feature_registration/pipeline.hpp"
#include "loopmark/storage/byte_stream.hpp"

namespace loopmark::feature_registration {
namespace {

using registration::PreparedCloud;
using registration::PreparedCloudPtr;
using registration::RegistrationResult;

class DescribedCloud : public PreparedCloud {
 public:
  DescribedCloud(std::vector<Eigen::Vector3f> points, DescribedScan scan)
      : points_(std::move(points)), scan_(std::move(scan)) {}
  const DescribedScan& scan() const { return scan_; }
  std::string to_bytes() const override {
    storage::ByteWriter writer;
    writer.points(points_);
    return storage::sealed(writer.bytes());
  }

 private:
  std::vector<Eigen::Vector3f> points_;
  DescribedScan scan_;
};

/// Throws std::invalid_argument on what another algorithm has prepared.
const DescribedScan& scan_of(const PreparedCloud& cloud) {
  const auto* const own = dynamic_cast<const DescribedCloud*>(&cloud);
  if (own == nullptr) {
    throw std::invalid_argument("feature registration registers what it has prepared itself");
  }
  return own->scan();
}

class FeatureRegistration : public registration::PairRegistration {
 public:
  FeatureRegistration(std::string name, const FeatureRegistrationOptions& options)
      : name_(std::move(name)), options_(options) {}

  const std::string& name() const override { return name_; }

  PreparedCloudPtr prepare(const PointCloud& cloud) const override {
    return std::make_shared<DescribedCloud>(cloud.points, describe_scan(cloud, options_));
  }

  PreparedCloudPtr restore(const std::string& bytes) const override {
    const std::string content = storage::unsealed(bytes, "prepared scan");
    storage::ByteReader reader(content);
    PointCloud cloud;
    cloud.points = reader.points();
    return prepare(cloud);
  }

  RegistrationResult align(const PreparedCloud& source, const PreparedCloud& target) const override {
    const FeatureRegistrationResult found = register_described(scan_of(source), scan_of(target), options_);
    RegistrationResult result = found.found && options_.refine ? judged(found.refinement) : RegistrationResult{};
    result.timings = found.timings;
    result.answered = found.found;
    if (!found.found) {
      result.reason = "no motion fits enough matches";
      return result;
    }
    result.T_target_source = found.T_target_source;
    const auto numbers = registration::Evidence{{"mutual_matches", static_cast<double>(found.mutual_matches)},
                                                {"used_matches", static_cast<double>(found.used_matches)},
                                                {"inliers", static_cast<double>(found.estimate.inliers.size())}};
    result.modes = {{found.T_target_source, result.p_correct, name_, numbers}};
    return result;
  }

  RegistrationResult verify(const PreparedCloud& source, const PreparedCloud& target,
                            const Pose& T_target_source) const override {
    const refinement::IcpTarget surface(scan_of(target).surface, options_.icp.max_distance_m);
    RegistrationResult result =
        judged(refinement::icp(scan_of(source).surface, surface, T_target_source, options_.icp));
    result.modes = {{result.T_target_source, result.p_correct, name_, {}}};
    return result;
  }

 private:
  static RegistrationResult judged(const refinement::IcpResult& refined) {
    RegistrationResult result;
    result.T_target_source = refined.T_target_source;
    result.covariance = refined.covariance;
    result.p_correct = refined.inlier_share;
    result.answered = refined.stop != refinement::IcpStop::kTooFewPairs;
    result.reason = result.answered ? "" : "too few points lie on each other";
    return result;
  }

  std::string name_;
  FeatureRegistrationOptions options_;
};

}  // namespace

registration::PairRegistrationPtr feature_registration(const std::string& name,
                                                       const FeatureRegistrationOptions& options) {
  return std::make_shared<FeatureRegistration>(name, options);
}

}  // namespace loopmark::feature_registration
