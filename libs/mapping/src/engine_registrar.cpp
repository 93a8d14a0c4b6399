// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/engine_registrar.hpp"

namespace loopmark::mapping {
namespace {

class EngineRegistrar : public Registrar {
 public:
  explicit EngineRegistrar(const registration::EngineOptions& options) : options_(options) {}

  std::string prepare(const PointCloud& cloud) const override {
    return registration::prepare_scan(cloud, options_).to_bytes();
  }

  std::string join(const std::vector<PointCloud>& clouds, const std::vector<Pose>& T_submap_scan) const override {
    return registration::prepare_submap(clouds, T_submap_scan, options_).to_bytes();
  }

  registration::RegistrationResult align(const std::string& source, const std::string& target) const override {
    return registration::register_scans(registration::PreparedScan::from_bytes(source),
                                        registration::PreparedScan::from_bytes(target), options_);
  }

  registration::RegistrationResult verify(const std::string& source, const std::string& target,
                                          const Pose& T_target_source) const override {
    return registration::verify_motion(registration::PreparedScan::from_bytes(source),
                                       registration::PreparedScan::from_bytes(target), T_target_source, options_);
  }

 private:
  registration::EngineOptions options_;
};

}  // namespace

std::shared_ptr<const Registrar> engine_registrar(const registration::EngineOptions& options) {
  return std::make_shared<EngineRegistrar>(options);
}

}  // namespace loopmark::mapping
