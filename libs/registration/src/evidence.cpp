// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evidence.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark {
namespace {

constexpr float kMet = 0.4F;     // metres
constexpr float kTight = 0.15F;  // metres
constexpr float kPlanar = 0.5F;
constexpr float kTestified = 80.0F;   // metres from the other sensor within which free space counts
constexpr float kSpreadCell = 10.0F;  // metres
constexpr float kTall = 2.2F;         // metres above the ground
constexpr float kMostGap = 0.2F;      // metres
constexpr double kDoubt = 10.0;       // patches: how many it takes to believe a share

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
    if (sight >= RangeImage::Sight::kConflict ? sight > verdict : verdict == RangeImage::Sight::kUnknown) {
      verdict = sight;
    }
  }
  return verdict;
}

void meet(Testimony& t, const Eigen::Vector3f& p, const Eigen::Vector3f& normal, const Patch& own, const Patch& other,
          double weight) {
  t.tight += std::abs(other.normal.dot(other.mean - p)) < kTight ? weight : 0.0;
  if (own.planarity > kPlanar && other.planarity > kPlanar) {
    const double cosine = normal.dot(other.normal);
    t.alike += weight * cosine * cosine;
    t.planar += weight;
  }
}

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// A share that starts at one half and moves away from it as patches speak.
double believed_share(double part, double whole) { return (part + 0.5 * kDoubt) / (whole + kDoubt); }

Voices sum(const Voices& a, const Voices& b) {
  return {a.met + b.met, a.conflict + b.conflict, a.clash + b.clash, a.unmet + b.unmet};
}

/// Of what should be seen, the share that is.
double presence(const Voices& v) { return believed_share(v.met, v.met + v.unmet); }

/// How much speaks against, on a logarithmic scale: from nothing to a little matters more than from much to more.
double log_conflict(const Voices& v) { return std::log((v.conflict + 1.0) / (v.conflict + v.met + kDoubt)); }
double log_clash(const Voices& v) { return std::log((v.clash + 1.0) / (v.clash + v.met + kDoubt)); }

/// Of all that the other scan can say something of, the share that it confirms.
double explained(const Voices& low, const Voices& tall) {
  const Voices v = sum(low, tall);
  return believed_share(v.met, v.met + v.unmet + v.conflict);
}

/// How well the least constrained direction of translation is held: 0 (slides freely) to 1/3.
double constraint(const Alignment& alignment) {
  const Eigen::Matrix3d h = alignment.information.topLeftCorner<3, 3>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(h);
  return std::max(0.0, solver.eigenvalues()[0]) / std::max(1e-9, h.trace());
}

}  // namespace

Inquiry::Side::Side(const PreparedScan::Data& scan, std::size_t asked)
    : map(&scan.fine),
      structure(sampled_structure(scan.fine.patches(), asked)),
      ground(sampled_ground(scan.fine.patches(), asked / 3)) {
  const auto standing = std::count_if(scan.fine.patches().begin(), scan.fine.patches().end(),
                                      [](const Patch& patch) { return patch.height > kStructureHeight; });
  const double all = std::min<double>(static_cast<double>(kAllAsked), static_cast<double>(standing));
  stands_for = all / std::max<double>(1.0, static_cast<double>(structure.size()));
  ground_stands_for = static_cast<double>(kAllAsked) / static_cast<double>(std::max<std::size_t>(asked, 3));
  for (const View& view : scan.views) {
    witnesses.push_back({view.T_level_sensor.inverse().cast<float>(), &view.image});
  }
}

Inquiry::Inquiry(const PreparedScan::Data& source, const PreparedScan::Data& target, std::size_t asked)
    : source_(source, asked), target_(target, asked) {}

Testimony Inquiry::ask(const Side& from, const Side& to, const Pose& T_to_from) {
  const Eigen::Isometry3f T = T_to_from.cast<float>();
  const Eigen::Matrix3f R = T.linear();
  const double w = from.stands_for;
  Testimony t;
  VoxelTable cells(256);
  std::vector<double> met_in_cell;
  for (const Patch& patch : from.structure) {
    const Eigen::Vector3f p = T * patch.mean;
    t.structure += w;
    Voices& voices = patch.height > kTall ? t.tall : t.low;
    if (const Patch* other = to.map->nearest(p, kMet)) {
      voices.met += w;
      meet(t, p, R * patch.normal, patch, *other, w);
      const std::uint32_t cell = cells.insert(voxel_of({p.x(), p.y(), 0.0F}, 1.0F / kSpreadCell));
      met_in_cell.resize(cells.size(), 0.0);
      met_in_cell[cell] += w;
      continue;
    }
    const auto sight = look_from_all(to.witnesses, p);
    voices.conflict += sight >= RangeImage::Sight::kConflict ? w : 0.0;
    voices.clash += sight == RangeImage::Sight::kClash ? w : 0.0;
    voices.unmet += sight == RangeImage::Sight::kAgrees ? w : 0.0;
  }
  t.cells =
      static_cast<double>(std::count_if(met_in_cell.begin(), met_in_cell.end(), [](double n) { return n >= 5.0; }));
  ask_ground(from, to, T, t);
  return t;
}

/// How the ground of one scan lies on that of the other.
void Inquiry::ask_ground(const Side& from, const Side& to, const Eigen::Isometry3f& T, Testimony& t) {
  const double w = from.ground_stands_for;
  for (const Patch& patch : from.ground) {
    const Eigen::Vector3f p = T * patch.mean;
    const Patch* other = to.map->nearest(p, kMet);
    if (other != nullptr && other->height < kGroundHeight) {
      t.ground += w;
      t.ground_step += w * static_cast<double>(std::min(kMostGap, std::abs(other->normal.dot(other->mean - p))));
    }
  }
}

Features Inquiry::features(const Alignment& alignment, const PeakHeights& peak) const {
  const Testimony a = ask(source_, target_, alignment.T_target_source);
  const Testimony b = ask(target_, source_, alignment.T_target_source.inverse());
  const Voices low = sum(a.low, b.low);
  const Voices tall = sum(a.tall, b.tall);
  const double met = a.met() + b.met();
  return {0.5 * (share(a.met(), a.structure) + share(b.met(), b.structure)),
          presence(low),
          log_conflict(low),
          log_clash(low),
          presence(tall),
          log_conflict(tall),
          log_clash(tall),
          explained(low, tall),
          believed_share(a.alike + b.alike, a.planar + b.planar),
          believed_share(a.tight + b.tight, met),
          alignment.residual_m,
          std::min(peak.own, 60.0),
          share(peak.own, peak.highest),
          std::log1p(met),
          std::log1p(tall.met),
          std::log1p(0.5 * (a.cells + b.cells)),
          constraint(alignment),
          std::log1p(a.ground + b.ground),
          (a.ground_step + b.ground_step + 0.1 * kDoubt) / (a.ground + b.ground + kDoubt),
          std::exp(-0.1 * alignment.T_target_source.translation().norm())};
}

}  // namespace loopmark
