// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evidence.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kAsked = 2000;  // structure patches a direction
constexpr float kMet = 0.4F;          // metres
constexpr float kTight = 0.15F;       // metres
constexpr float kPlanar = 0.5F;
constexpr float kTestified = 80.0F;   // metres from the other sensor within which free space counts
constexpr float kSpreadCell = 10.0F;  // metres
constexpr float kTall = 2.2F;         // metres above the ground
constexpr double kLowOverlap = 0.25;
constexpr double kDoubt = 10.0;  // patches: how many it takes to believe a share

/// A viewpoint, turned round once for all points that it is asked about.
struct Witness {
  Eigen::Isometry3f T_sensor_level;
  const RangeImage* image;
};

std::vector<Witness> witnesses_of(const PreparedScan::Data& scan) {
  std::vector<Witness> witnesses;
  for (const View& view : scan.views) {
    witnesses.push_back({view.T_level_sensor.inverse().cast<float>(), &view.image});
  }
  return witnesses;
}

/// What all viewpoints of a scan say of a point in its levelled frame: agreement outweighs conflict.
RangeImage::Sight look_from_all(const std::vector<Witness>& witnesses, const Eigen::Vector3f& point) {
  auto verdict = RangeImage::Sight::kUnknown;
  for (const Witness& witness : witnesses) {
    const Eigen::Vector3f seen = witness.T_sensor_level * point;
    const float range = seen.norm();
    if (range > kTestified) {
      continue;
    }
    const auto sight = witness.image->look_at(seen, 0.8F + 0.02F * range);
    if (sight == RangeImage::Sight::kAgrees) {
      return sight;
    }
    if (sight == RangeImage::Sight::kConflict || verdict == RangeImage::Sight::kUnknown) {
      verdict = sight;
    }
  }
  return verdict;
}

void meet(Testimony& t, const Eigen::Vector3f& p, const Eigen::Vector3f& normal, const Patch& own, const Patch& other) {
  t.tight += std::abs(other.normal.dot(other.mean - p)) < kTight ? 1.0 : 0.0;
  if (own.planarity > kPlanar && other.planarity > kPlanar) {
    const double cosine = normal.dot(other.normal);
    t.alike += cosine * cosine;
    t.planar += 1.0;
  }
}

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// A share that starts at one half and moves away from it as patches speak.
double believed_share(double part, double whole) { return (part + 0.5 * kDoubt) / (whole + kDoubt); }

Voices sum(const Voices& a, const Voices& b) { return {a.met + b.met, a.conflict + b.conflict, a.unmet + b.unmet}; }

/// Of what should be seen, the share that is.
double presence(const Voices& v) { return believed_share(v.met, v.met + v.unmet); }

/// How much speaks against, on a logarithmic scale: from nothing to a little matters more than from much to more.
double log_conflict(const Voices& v) { return std::log((v.conflict + 1.0) / (v.conflict + v.met + kDoubt)); }

/// How well the least constrained direction of translation is held: 0 (slides freely) to 1/3.
double constraint(const Alignment& alignment) {
  const Eigen::Matrix3d h = alignment.information.topLeftCorner<3, 3>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(h);
  return std::max(0.0, solver.eigenvalues()[0]) / std::max(1e-9, h.trace());
}

}  // namespace

Testimony ask(const PreparedScan::Data& source, const PreparedScan::Data& target, const Pose& T_target_source) {
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  const Eigen::Matrix3f R = T.linear();
  const std::vector<Witness> witnesses = witnesses_of(target);
  Testimony t;
  VoxelTable cells(256);
  std::vector<int> met_in_cell;
  for (const Patch& patch : sampled_structure(source.fine.patches(), kAsked)) {
    const Eigen::Vector3f p = T * patch.mean;
    t.structure += 1.0;
    Voices& voices = patch.height > kTall ? t.tall : t.low;
    if (const Patch* other = target.fine.nearest(p, kMet)) {
      voices.met += 1.0;
      meet(t, p, R * patch.normal, patch, *other);
      const std::uint32_t cell = cells.insert(voxel_of({p.x(), p.y(), 0.0F}, 1.0F / kSpreadCell));
      met_in_cell.resize(cells.size(), 0);
      ++met_in_cell[cell];
      continue;
    }
    const auto sight = look_from_all(witnesses, p);
    voices.conflict += sight == RangeImage::Sight::kConflict ? 1.0 : 0.0;
    voices.unmet += sight == RangeImage::Sight::kAgrees ? 1.0 : 0.0;
  }
  t.cells = static_cast<double>(std::count_if(met_in_cell.begin(), met_in_cell.end(), [](int n) { return n >= 5; }));
  return t;
}

Features features_of(const PreparedScan::Data& source, const PreparedScan::Data& target, const Alignment& alignment,
                     double peak) {
  const Testimony a = ask(source, target, alignment.T_target_source);
  const Testimony b = ask(target, source, alignment.T_target_source.inverse());
  const Voices low = sum(a.low, b.low);
  const Voices tall = sum(a.tall, b.tall);
  const double met = a.met() + b.met();
  const double agreement = 0.5 * (share(a.met(), a.structure) + share(b.met(), b.structure));
  return {std::min(agreement, kLowOverlap),
          presence(low),
          log_conflict(low),
          presence(tall),
          log_conflict(tall),
          believed_share(a.alike + b.alike, a.planar + b.planar),
          believed_share(a.tight + b.tight, met),
          alignment.residual_m,
          std::min(peak, 60.0),
          std::log1p(met),
          std::log1p(0.5 * (a.cells + b.cells)),
          constraint(alignment),
          std::max(0.0, agreement - kLowOverlap)};
}

}  // namespace loopmark
