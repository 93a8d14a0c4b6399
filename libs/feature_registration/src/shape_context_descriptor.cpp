// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "shape_context_descriptor.hpp"

#include <utility>

#include "loopmark/shape_context/fourier_shape_context.hpp"

namespace loopmark::feature_registration::internal {
namespace {

class ShapeContextDescriptor : public Descriptor {
 public:
  explicit ShapeContextDescriptor(const shape_context::Options& options) : options_(options) {}

  bool needs_normals() const override { return false; }

  LocalFeatures describe(const PointCloud& cloud, const refinement::Surface& /*surface*/) const override {
    shape_context::Keypoints keypoints = shape_context::describe_scan(cloud.points, options_);
    return {std::move(keypoints.points), std::move(keypoints.descriptors)};
  }

 private:
  shape_context::Options options_;
};

}  // namespace

std::unique_ptr<Descriptor> make_shape_context_descriptor(const FeatureRegistrationOptions& options) {
  return std::make_unique<ShapeContextDescriptor>(options.fsc);
}

}  // namespace loopmark::feature_registration::internal
