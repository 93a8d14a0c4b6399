// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/feature_registration/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <initializer_list>
#include <stdexcept>
#include <utility>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/feature_registration/descriptor.hpp"

namespace loopmark::feature_registration {
namespace {

/// Runs one step and notes how long it took.
template <class Step>
auto timed(std::vector<registration::StageTime>& timings, const char* stage, const Step& step) {
  const auto start = std::chrono::steady_clock::now();
  auto result = step();
  timings.push_back({stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
  return result;
}

double seconds_of(const std::vector<registration::StageTime>& timings, std::initializer_list<const char*> stages) {
  double sum = 0.0;
  for (const registration::StageTime& time : timings) {
    const bool wanted =
        std::any_of(stages.begin(), stages.end(), [&](const char* stage) { return time.stage == stage; });
    sum += wanted ? time.seconds : 0.0;
  }
  return sum;
}

std::vector<Eigen::Vector3f> downsample(const PointCloud& cloud, const FeatureRegistrationOptions& options) {
  std::vector<Eigen::Vector3f> points;
  std::copy_if(cloud.points.begin(), cloud.points.end(), std::back_inserter(points),
               [](const Eigen::Vector3f& p) { return p.allFinite(); });
  if (options.voxel_point == VoxelPoint::kCentroid) {
    return cloud::voxel_centroids(points, options.voxel_m);
  }
  std::vector<Eigen::Vector3f> kept;
  for (const std::size_t i : cloud::voxel_first_indices(points, options.voxel_m)) {
    kept.push_back(points[i]);
  }
  return kept;
}

struct RowsShape {
  std::size_t rows = 0;
  std::size_t columns = 0;
  bool quantized = false;
};

RowsShape shape_of(const search::DescriptorRows& descriptors) {
  return std::visit(
      [&](const auto& rows) {
        return RowsShape{static_cast<std::size_t>(rows.rows()), static_cast<std::size_t>(rows.cols()),
                         std::holds_alternative<search::QuantizedDescriptors>(descriptors)};
      },
      descriptors);
}

bool refinement_wants_normals(const FeatureRegistrationOptions& options) {
  return options.refine && options.icp.metric != refinement::IcpMetric::kPointToPoint;
}

matching::Correspondences filter_matches(const matching::Correspondences& matches,
                                         const std::vector<Eigen::Vector3f>& source,
                                         const FeatureRegistrationOptions& options) {
  matching::Correspondences kept = options.max_ratio < 1.0 ? matching::keep_ratio(matches, options.max_ratio) : matches;
  switch (options.filter) {
    case MatchFilter::kAll:
      break;
    case MatchFilter::kMutual:
      kept = matching::keep_mutual(kept);
      break;
    case MatchFilter::kGpf:
      kept = matching::grid_prioritized_filter(kept, source, options.gpf);
      break;
  }
  return matching::keep_best(std::move(kept), options.max_matches);
}

estimation::Estimate estimate_motion(const estimation::PointPairs& pairs, const FeatureRegistrationOptions& options) {
  switch (options.estimator) {
    case Estimator::kRansac:
      return estimation::ransac(pairs, options.ransac);
    case Estimator::kGnc:
      return estimation::gnc_clique(pairs, options.gnc);
    case Estimator::kSpatialConsistency:
      return estimation::spatial_consistency(pairs, options.spatial_consistency);
  }
  return {};
}

}  // namespace

DescribedScan describe_scan(const PointCloud& cloud, const FeatureRegistrationOptions& options) {
  check(options);
  const std::unique_ptr<Descriptor> descriptor = make_descriptor(options);
  DescribedScan scan;
  scan.surface.points = timed(scan.timings, "downsample", [&] { return downsample(cloud, options); });
  if (descriptor->needs_normals() || refinement_wants_normals(options)) {
    scan.surface.normals = timed(scan.timings, "normals", [&] {
      return features::estimate_normals(scan.surface.points, options.normals).vectors;
    });
  }
  LocalFeatures features =
      timed(scan.timings, "descriptors", [&] { return descriptor->describe(cloud, scan.surface); });
  scan.keypoints = std::move(features.points);
  scan.descriptors = std::move(features.descriptors);
  return scan;
}

DescribedScan described_scan(std::vector<Eigen::Vector3f> keypoints, search::DescriptorRows descriptors,
                             const PointCloud& cloud, const FeatureRegistrationOptions& options) {
  check(options);
  if (shape_of(descriptors).rows != keypoints.size()) {
    throw std::invalid_argument("described_scan: as many keypoints as descriptors are needed");
  }
  DescribedScan scan;
  scan.surface.points =
      timed(scan.timings, "downsample", [&] { return cloud.empty() ? keypoints : downsample(cloud, options); });
  if (refinement_wants_normals(options)) {
    scan.surface.normals = timed(scan.timings, "normals", [&] {
      return features::estimate_normals(scan.surface.points, options.normals).vectors;
    });
  }
  scan.keypoints = std::move(keypoints);
  scan.descriptors = std::move(descriptors);
  return scan;
}

void require_comparable(const DescribedScan& source, const std::string& source_origin, const DescribedScan& target,
                        const std::string& target_origin) {
  const RowsShape a = shape_of(source.descriptors);
  const RowsShape b = shape_of(target.descriptors);
  if (a.rows == 0 || b.rows == 0 || (a.columns == b.columns && a.quantized == b.quantized)) {
    return;
  }
  const auto named = [](const RowsShape& shape) {
    return std::to_string(shape.columns) + (shape.quantized ? " whole numbers" : " numbers");
  };
  throw InputError(
      source_origin, "",
      "has descriptors of " + named(a) + ", " + target_origin + " of " + named(b) + ": they cannot be compared",
      "describe both scans alike");
}

ScanMatches match_described(const DescribedScan& source, const DescribedScan& target) {
  ScanMatches matches;
  matches.all = timed(matches.timings, "nearest", [&] {
    return matching::correspondences_of(matching::nearest_two(source.descriptors, target.descriptors));
  });
  matches.mutual = matching::keep_mutual(matches.all).size();
  return matches;
}

FeatureRegistrationResult register_described(const DescribedScan& source, const DescribedScan& target,
                                             const FeatureRegistrationOptions& options) {
  return register_matched(source, target, match_described(source, target), options);
}

FeatureRegistrationResult register_matched(const DescribedScan& source, const DescribedScan& target,
                                           const ScanMatches& matches, const FeatureRegistrationOptions& options) {
  check(options);
  FeatureRegistrationResult result;
  result.timings = matches.timings;
  result.matches = matches.all.size();
  result.mutual_matches = matches.mutual;
  // Sec. 4 and appendix "GPF": mutual nearest neighbours, or Grid-Prioritized Filtering.
  result.used = timed(result.timings, "filter", [&] { return filter_matches(matches.all, source.keypoints, options); });
  result.used_matches = result.used.size();
  // Sec. 5: robust estimation of the motion.
  result.estimate = timed(result.timings, "estimate", [&] {
    return estimate_motion(estimation::PointPairs::of(result.used, source.keypoints, target.keypoints), options);
  });
  result.found = result.estimate.found;
  result.T_coarse = result.estimate.T_target_source;
  result.T_target_source = result.T_coarse;
  // Appendix "Local Registration": ICP on the downsampled clouds.
  if (options.refine && result.found) {
    result.refinement = timed(result.timings, "refine", [&] {
      return refinement::icp(source.surface, refinement::IcpTarget(target.surface, options.icp.max_distance_m),
                             result.T_coarse, options.icp);
    });
    result.T_target_source = result.refinement.T_target_source;
  }
  return result;
}

FeatureRegistrationResult register_features(const PointCloud& source, const PointCloud& target,
                                            const FeatureRegistrationOptions& options) {
  const DescribedScan described_source = describe_scan(source, options);
  const DescribedScan described_target = describe_scan(target, options);
  FeatureRegistrationResult result = register_described(described_source, described_target, options);
  std::vector<registration::StageTime> timings = described_source.timings;
  timings.insert(timings.end(), described_target.timings.begin(), described_target.timings.end());
  timings.insert(timings.end(), result.timings.begin(), result.timings.end());
  result.timings = std::move(timings);
  return result;
}

double FeatureRegistrationResult::algorithm_seconds() const { return seconds_of(timings, {"filter", "estimate"}); }

double FeatureRegistrationResult::with_refinement_seconds() const {
  return seconds_of(timings, {"filter", "estimate", "refine"});
}

double FeatureRegistrationResult::all_seconds() const {
  return seconds_of(timings, {"downsample", "normals", "descriptors", "nearest", "filter", "estimate", "refine"});
}

}  // namespace loopmark::feature_registration
