// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "fpfh_descriptor.hpp"

namespace loopmark::feature_registration::internal {
namespace {

class FpfhDescriptor : public Descriptor {
 public:
  explicit FpfhDescriptor(const FeatureRegistrationOptions& options)
      : fpfh_(options.fpfh), match_ground_(options.match_ground), ground_(options.ground) {}

  bool needs_normals() const override { return true; }

  LocalFeatures describe(const PointCloud& /*cloud*/, const refinement::Surface& surface) const override {
    std::vector<bool> left_out(surface.points.size(), false);
    if (!match_ground_) {
      left_out = features::ground_points(surface.points, surface.normals, ground_);
    }
    LocalFeatures out;
    std::vector<std::size_t> matched;
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
      if (!left_out[i] && !surface.normals[i].isZero()) {
        matched.push_back(i);
        out.points.push_back(surface.points[i]);
      }
    }
    out.descriptors = matched.empty() ? search::DescriptorMatrix(0, features::kFpfhDimension)
                                      : features::fpfh(surface.points, surface.normals, fpfh_, matched);
    return out;
  }

 private:
  features::FpfhOptions fpfh_;
  bool match_ground_;
  features::GroundOptions ground_;
};

}  // namespace

std::unique_ptr<Descriptor> make_fpfh_descriptor(const FeatureRegistrationOptions& options) {
  return std::make_unique<FpfhDescriptor>(options);
}

}  // namespace loopmark::feature_registration::internal
