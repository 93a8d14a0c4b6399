// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evidence.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark {
namespace {

constexpr float kMet = 0.4F;         // metres
constexpr float kRunsOn = 1.2F;      // metres: how far a surface is carried on between beams
constexpr float kOffSurface = 0.3F;  // metres
constexpr float kPlanar = 0.5F;
constexpr float kTestified = 80.0F;  // metres from the other sensor within which free space counts
constexpr float kTall = 2.2F;        // metres above the ground
constexpr float kBeside = 0.6F;      // metres to the side, where an object may lean on something tall
constexpr float kFar = 25.0F;        // metres from a sensor
constexpr float kCell = 5.0F;        // metres
constexpr double kFewInCell = 3.0;   // patches that contradict
constexpr float kMostGap = 0.2F;     // metres
constexpr double kDoubt = 10.0;      // patches: how many it takes to believe a share

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

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

Voices& operator+=(Voices& a, const Voices& b) {
  a.met += b.met;
  a.near += b.near;
  a.absent += b.absent;
  a.conflict += b.conflict;
  a.clash += b.clash;
  return a;
}

Voices operator+(Voices a, const Voices& b) { return a += b; }

Voices operator*(double w, const Voices& v) {
  return {w * v.met, w * v.near, w * v.absent, w * v.conflict, w * v.clash};
}

/// How much speaks against, on a logarithmic scale: from nothing to a little matters more than from much to more.
double log_against(double against, double for_it) { return std::log((against + 1.0) / (against + for_it + kDoubt)); }

/// The voices of a square of the ground plane.
struct Cell {
  Voices all;
  Voices tall;
};

/// Which patches are objects: low, with nothing tall above them or beside.
std::vector<bool> objects_among(const std::vector<Patch>& structure, const std::vector<Patch>& all) {
  const auto square = [](float x, float y) { return voxel_of({x, y, 0.0F}, 1.0F); };
  VoxelTable below_tall(all.size() / 4);
  for (const Patch& patch : all) {
    if (patch.height > kTall) {
      below_tall.insert(square(patch.mean.x(), patch.mean.y()));
    }
  }
  const auto is_object = [&](const Patch& patch) {
    bool alone = patch.height <= kTall;
    for (const float dx : {-kBeside, 0.0F, kBeside}) {
      for (const float dy : {-kBeside, 0.0F, kBeside}) {
        alone = alone && below_tall.find(square(patch.mean.x() + dx, patch.mean.y() + dy)) == VoxelTable::kNone;
      }
    }
    return alone;
  };
  std::vector<bool> flags;
  flags.reserve(structure.size());
  for (const Patch& patch : structure) {
    flags.push_back(is_object(patch));
  }
  return flags;
}

/// Whether the surface at a point, seen coarsely, is one on which the point may lie.
bool surface_runs_on(const PatchMap& coarse, const Eigen::Vector3f& point) {
  const Patch* wide = coarse.nearest(point, kRunsOn);
  return wide != nullptr && (wide->planarity < kPlanar || std::abs(wide->normal.dot(wide->mean - point)) < kOffSurface);
}

/// Log of how many fine patches a coarse one holds on average.
double fill_of(const PreparedScan::Data& scan) {
  const auto fine = static_cast<double>(scan.fine.patches().size());
  return std::log(std::max(1.0, fine) / std::max(1.0, static_cast<double>(scan.coarse.patches().size())));
}

}  // namespace

Inquiry::Side::Side(const PreparedScan::Data& scan, std::size_t asked)
    : map(&scan.fine),
      coarse(&scan.coarse),
      structure(sampled_structure(scan.fine.patches(), asked)),
      ground(sampled_ground(scan.fine.patches(), asked / 3)) {
  fill = fill_of(scan);
  is_object = objects_among(structure, scan.fine.patches());
  standing = static_cast<double>(std::count_if(scan.fine.patches().begin(), scan.fine.patches().end(),
                                               [](const Patch& patch) { return patch.height > kStructureHeight; }));
  const double all = std::min(static_cast<double>(kAllAsked), standing);
  stands_for = all / std::max<double>(1.0, static_cast<double>(structure.size()));
  ground_stands_for = static_cast<double>(kAllAsked) / static_cast<double>(std::max<std::size_t>(asked, 3));
  for (const View& view : scan.views) {
    witnesses.push_back({view.T_level_sensor.inverse().cast<float>(), &view.image});
  }
}

Inquiry::Inquiry(const PreparedScan::Data& source, const PreparedScan::Data& target, std::size_t asked)
    : source_(source, asked), target_(target, asked) {}

/// What the other scan says of one point, moved into its levelled frame.
Voices Inquiry::ask(const Eigen::Vector3f& moved, const Side& to) {
  Voices v;
  if (to.map->nearest(moved, kMet) != nullptr) {
    v.met = 1.0;
    return v;
  }
  const auto sight = look_from_all(to.witnesses, moved);
  if (sight == RangeImage::Sight::kAgrees) {
    (surface_runs_on(*to.coarse, moved) ? v.near : v.absent) = 1.0;
  }
  v.conflict = sight >= RangeImage::Sight::kConflict ? 1.0 : 0.0;
  v.clash = sight == RangeImage::Sight::kClash ? 1.0 : 0.0;
  return v;
}

Testimony Inquiry::ask(const Side& from, const Side& to, const Pose& T_to_from) {
  const Eigen::Isometry3f T = T_to_from.cast<float>();
  Testimony t;
  VoxelTable squares(256);
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < from.structure.size(); ++i) {
    const Patch& patch = from.structure[i];
    const Eigen::Vector3f p = T * patch.mean;
    const Voices voices = from.stands_for * ask(p, to);
    const bool tall = patch.height > kTall;
    t.structure += from.stands_for;
    (tall ? t.tall : t.low) += voices;
    t.objects += from.is_object[i] ? voices : Voices();
    t.far += patch.mean.norm() > kFar && p.norm() > kFar ? voices : Voices();
    const std::uint32_t square = squares.insert(voxel_of({p.x(), p.y(), 0.0F}, 1.0F / kCell));
    cells.resize(squares.size());
    cells[square].all += voices;
    cells[square].tall += tall ? voices : Voices();
  }
  for (const Cell& cell : cells) {
    t.contradicted += cell.all.conflict >= kFewInCell && cell.all.conflict > 2.0 * cell.all.met ? 1.0 : 0.0;
    t.tall_contradicted += cell.tall.clash >= kFewInCell && cell.tall.clash > 2.0 * cell.tall.met ? 1.0 : 0.0;
  }
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
  const Pose& T = alignment.T_target_source;
  const Testimony a = ask(source_, target_, T);
  const Testimony b = ask(target_, source_, T.inverse());
  const Voices low = a.low + b.low;
  const Voices tall = a.tall + b.tall;
  const Voices objects = a.objects + b.objects;
  const Voices far = a.far + b.far;
  return {0.5 * (share(a.met(), a.structure) + share(b.met(), b.structure)),
          log_against(low.absent, low.met + low.near),
          log_against(tall.clash, tall.met),
          log_against(objects.clash, objects.met),
          log_against(far.conflict, far.met),
          std::log1p(a.contradicted + b.contradicted),
          std::log1p(a.tall_contradicted + b.tall_contradicted),
          alignment.residual_m,
          std::log1p(objects.met),
          std::min(peak.own, 60.0),
          std::clamp(std::log((peak.own + 0.1) / (peak.usual + 0.1)), -1.0, 2.0),
          std::log1p(a.ground + b.ground),
          (a.ground_step + b.ground_step + 0.1 * kDoubt) / (a.ground + b.ground + kDoubt),
          std::exp(-0.1 * T.translation().norm()),
          std::log1p(std::min(source_.standing, target_.standing)),
          std::log1p(std::max(source_.standing, target_.standing)),
          std::min(source_.fill, target_.fill),
          std::max(source_.fill, target_.fill)};
}

}  // namespace loopmark
