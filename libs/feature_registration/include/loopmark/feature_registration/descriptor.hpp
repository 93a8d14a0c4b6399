// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The role of a local descriptor in the paper's pipeline, and all that fill it by name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/feature_registration/options.hpp"
#include "loopmark/refinement/icp.hpp"
#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::feature_registration {

/// Keypoints of a scan with their descriptors, one a row, of floats or quantised.
struct LocalFeatures {
  std::vector<Eigen::Vector3f> points;  ///< metres, in the sensor's frame
  search::DescriptorRows descriptors;
};

/// Describes scans. A new one: a class in a file of its own and a line in descriptors().
class Descriptor {
 public:
  virtual ~Descriptor() = default;
  /// Whether describe() wants the normals of the surface.
  virtual bool needs_normals() const = 0;
  /// `cloud`: the scan as it is, in the sensor's frame, metres; `surface`: the same downsampled. The same bytes at any
  /// number of threads.
  virtual LocalFeatures describe(const PointCloud& cloud, const refinement::Surface& surface) const = 0;
};

struct NamedDescriptor {
  std::string name;
  std::string summary;
  std::unique_ptr<Descriptor> (*make)(const FeatureRegistrationOptions& options);
};

/// All descriptors that have a name, the default first.
const std::vector<NamedDescriptor>& descriptors();

/// The one of options.descriptor. Throws InputError listing the names when there is none of this name.
std::unique_ptr<Descriptor> make_descriptor(const FeatureRegistrationOptions& options);

}  // namespace loopmark::feature_registration
