// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/engine_registrar.hpp"

namespace loopmark {
namespace {

class EngineRegistrar : public Registrar {
 public:
  explicit EngineRegistrar(const EngineOptions& options) : options_(options) {}

  std::string prepare(const PointCloud& cloud) const override { return prepare_scan(cloud, options_).to_bytes(); }

  std::string join(const std::vector<PointCloud>& clouds, const std::vector<Pose>& T_submap_scan) const override {
    return prepare_submap(clouds, T_submap_scan, options_).to_bytes();
  }

  RegistrationResult align(const std::string& source, const std::string& target) const override {
    return register_scans(PreparedScan::from_bytes(source), PreparedScan::from_bytes(target), options_);
  }

  RegistrationResult verify(const std::string& source, const std::string& target,
                            const Pose& T_target_source) const override {
    return verify_motion(PreparedScan::from_bytes(source), PreparedScan::from_bytes(target), T_target_source, options_);
  }

 private:
  EngineOptions options_;
};

}  // namespace

std::shared_ptr<const Registrar> engine_registrar(const EngineOptions& options) {
  return std::make_shared<EngineRegistrar>(options);
}

}  // namespace loopmark
