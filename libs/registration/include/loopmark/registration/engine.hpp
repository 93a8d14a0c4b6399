// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Global registration of two scans without an initial guess: many hypotheses, one verification, and a
/// calibrated probability that the answer is right.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/registration/engine_options.hpp"

namespace loopmark::registration {

/// All that registration needs of one scan, or of several joined into a submap: computed once, kept by
/// keyframes, at most 1 MB. A cheap-to-copy immutable value.
class PreparedScan {
 public:
  struct Data;

  PreparedScan() = default;
  explicit PreparedScan(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  bool empty() const { return data_ == nullptr; }
  const Data& data() const { return *data_; }

  /// Bytes that from_bytes restores exactly. Throws InputError on bytes that are damaged.
  std::string to_bytes() const;
  static PreparedScan from_bytes(const std::string& bytes);

 private:
  std::shared_ptr<const Data> data_;
};

/// The numbers behind one hypothesis, by name, in a fixed order ("agreement", "conflict", "margin", ...).
using Evidence = std::vector<std::pair<std::string, double>>;

/// One distinct answer to where the source stands in the target.
struct RegistrationMode {
  Pose T_target_source = Pose::Identity();
  double p_correct = 0.0;
  std::string origin;  ///< the hypothesis source: "bev", "features", "guess"
  Evidence evidence;
};

struct StageTime {
  std::string stage;
  double seconds = 0.0;
};

struct RegistrationResult {
  Pose T_target_source = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of xi in exp(xi) * T_target_source; metres, radians
  double p_correct = 0.0;                      ///< calibrated probability: RE < 5 deg and TE < 0.6 m
  bool answered = false;                       ///< p_correct reached the option min_p_correct
  std::string reason;                          ///< why it abstained; empty when it answered
  std::vector<RegistrationMode> modes;         ///< distinct answers, the most probable first
  std::vector<StageTime> timings;
};

/// Prepares one scan (points in the sensor's frame; already deskewed where it moved during the sweep).
PreparedScan prepare_scan(const PointCloud& cloud, const EngineOptions& options);

/// Prepares several scans joined in the frame of the submap. T_submap_scan[i] places clouds[i].
PreparedScan prepare_submap(const std::vector<PointCloud>& clouds, const std::vector<Pose>& T_submap_scan,
                            const EngineOptions& options);

/// Finds T_target_source with no initial guess. The same bytes at any number of threads.
RegistrationResult register_scans(const PreparedScan& source, const PreparedScan& target, const EngineOptions& options);

/// Refines and judges a motion that is already believed (odometry, a person): the same evidence and probability.
RegistrationResult verify_motion(const PreparedScan& source, const PreparedScan& target, const Pose& T_target_source,
                                 const EngineOptions& options);

}  // namespace loopmark::registration
