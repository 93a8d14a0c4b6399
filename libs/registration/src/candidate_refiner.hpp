// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Candidates of one pair of scans, looked at more and more closely.
#pragma once

#include <string>
#include <vector>

#include "evidence.hpp"
#include "prepared_data.hpp"

namespace loopmark::registration::internal {

/// A motion between the levelled frames and what it rests on.
struct Candidate {
  Alignment alignment;
  std::string origin;
  PeakHeights peak;
  Features features{};
  double log_odds = 0.0;
};

/// How closely a candidate is looked at.
struct Effort {
  std::size_t coarse_surfels;
  int coarse_rounds;
  std::size_t fine_surfels;
  int fine_rounds;
  std::size_t samples;  ///< surfels of structure a direction
};

constexpr Effort kQuick = {400, 8, 600, 5, 400};
constexpr Effort kThorough = {800, 4, 1500, 8, kAllAsked};

/// Aligns candidates of one pair and asks the scans about them. All return the candidates that differ (by 1 m or 3
/// deg), the most probable first. The scans must outlive this.
class CandidateRefiner {
 public:
  CandidateRefiner(const PreparedScan::Data& source, const PreparedScan::Data& target, const Effort& effort);

  /// Coarse, then fine alignment on surfels, and what the scans say of the outcome.
  std::vector<Candidate> refine(std::vector<Candidate> candidates) const;

  /// Lays each candidate on the ground anew and aligns it finely from there; both are judged. Coarse surfels mix ground
  /// with what stands on it: they find the place well and the height badly.
  std::vector<Candidate> refit_ground(std::vector<Candidate> candidates) const;

  /// Tilts the best candidate about the middle between the sensors, across the line that joins them, and aligns it
  /// anew. Far apart on a hilly street, few rings of the ground are shared, and a sparse sensor's lie on each other one
  /// ring too high as well.
  std::vector<Candidate> perturb_pitch(std::vector<Candidate> candidates) const;

  /// Lays the best candidate on the ground and aligns it the other way round, the target's surfels on the source's
  /// surfaces; both are kept to choose from. Of sparse sensors far apart, either scan holds the tilt badly on the
  /// other's few rings, and errs in its own way.
  std::vector<Candidate> align_inverse(std::vector<Candidate> candidates) const;

  /// What the scans say of a candidate's motion, and its log-odds.
  void judge(Candidate& candidate) const;

 private:
  Candidate refined(Candidate candidate, int coarse_rounds) const;

  const PreparedScan::Data& source_;
  const PreparedScan::Data& target_;
  Effort effort_;
  std::vector<surfels::Surfel> coarse_;
  std::vector<surfels::Surfel> fine_;
  std::vector<surfels::Surfel> ground_;
  Verifier verifier_;
};

}  // namespace loopmark::registration::internal
