// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evidence.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark::registration::internal {
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
constexpr double kFewInCell = 3.0;   // surfels that contradict
constexpr float kMostGap = 0.2F;     // metres
constexpr double kDoubt = 10.0;      // surfels: how many it takes to believe a share

/// What all viewpoints of a scan say of a point in its levelled frame: agreement outweighs conflict.
RangeImage::Sight look_from_all(const std::vector<SensorView>& sensor_views, const Eigen::Vector3f& point) {
  auto verdict = RangeImage::Sight::kUnknown;
  for (const SensorView& sensor_view : sensor_views) {
    const Eigen::Vector3f seen = sensor_view.T_sensor_level * point;
    const float range = seen.norm();
    if (range > kTestified) {
      continue;
    }
    const auto sight = sensor_view.image->look_at(seen, 0.8F + 0.02F * range);
    if (sight == RangeImage::Sight::kAgrees) {
      return sight;
    }
    if (sight >= RangeImage::Sight::kFreeSpaceViolation ? sight > verdict : verdict == RangeImage::Sight::kUnknown) {
      verdict = sight;
    }
  }
  return verdict;
}

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

OverlapStatistics& operator+=(OverlapStatistics& a, const OverlapStatistics& b) {
  a.overlap += b.overlap;
  a.occluded_gap += b.occluded_gap;
  a.missing += b.missing;
  a.free_space_violation += b.free_space_violation;
  a.strong_violation += b.strong_violation;
  return a;
}

OverlapStatistics operator+(OverlapStatistics a, const OverlapStatistics& b) { return a += b; }

OverlapStatistics operator*(double w, const OverlapStatistics& v) {
  return {w * v.overlap, w * v.occluded_gap, w * v.missing, w * v.free_space_violation, w * v.strong_violation};
}

/// How much speaks against, on a logarithmic scale: from nothing to a little matters more than from much to more.
double log_against(double against, double for_it) { return std::log((against + 1.0) / (against + for_it + kDoubt)); }

/// The statistics of a square of the ground plane.
struct Cell {
  OverlapStatistics all;
  OverlapStatistics tall;
};

/// Which surfels are objects: low, with nothing tall above them or beside.
std::vector<bool> objects_among(const std::vector<surfels::Surfel>& structure,
                                const std::vector<surfels::Surfel>& all) {
  const auto square = [](float x, float y) { return search::voxel_of({x, y, 0.0F}, 1.0F); };
  search::VoxelTable below_tall(all.size() / 4);
  for (const surfels::Surfel& surfel : all) {
    if (surfel.height > kTall) {
      below_tall.insert(square(surfel.mean.x(), surfel.mean.y()));
    }
  }
  const auto is_object = [&](const surfels::Surfel& surfel) {
    bool alone = surfel.height <= kTall;
    for (const float dx : {-kBeside, 0.0F, kBeside}) {
      for (const float dy : {-kBeside, 0.0F, kBeside}) {
        alone =
            alone && below_tall.find(square(surfel.mean.x() + dx, surfel.mean.y() + dy)) == search::VoxelTable::kNone;
      }
    }
    return alone;
  };
  std::vector<bool> flags;
  flags.reserve(structure.size());
  for (const surfels::Surfel& surfel : structure) {
    flags.push_back(is_object(surfel));
  }
  return flags;
}

/// Whether the surface at a point, seen coarsely, is one on which the point may lie.
bool surface_runs_on(const surfels::SurfelMap& coarse, const Eigen::Vector3f& point) {
  const surfels::Surfel* wide = coarse.nearest(point, kRunsOn);
  return wide != nullptr && (wide->planarity < kPlanar || std::abs(wide->normal.dot(wide->mean - point)) < kOffSurface);
}

/// Log of how many fine surfels a coarse one holds on average.
double density_ratio_of(const PreparedScan::Data& scan) {
  const auto fine = static_cast<double>(scan.fine.surfels().size());
  return std::log(std::max(1.0, fine) / std::max(1.0, static_cast<double>(scan.coarse.surfels().size())));
}

}  // namespace

Verifier::Side::Side(const PreparedScan::Data& scan, std::size_t samples)
    : map(&scan.fine),
      coarse(&scan.coarse),
      structure(sampled_structure(scan.fine.surfels(), samples)),
      ground(sampled_ground(scan.fine.surfels(), samples / 3)) {
  density_ratio = density_ratio_of(scan);
  is_object = objects_among(structure, scan.fine.surfels());
  structure_count = static_cast<double>(
      std::count_if(scan.fine.surfels().begin(), scan.fine.surfels().end(),
                    [](const surfels::Surfel& surfel) { return surfel.height > kStructureHeight; }));
  const double all = std::min(static_cast<double>(kAllAsked), structure_count);
  sample_weight = all / std::max<double>(1.0, static_cast<double>(structure.size()));
  ground_sample_weight = static_cast<double>(kAllAsked) / static_cast<double>(std::max<std::size_t>(samples, 3));
  for (const View& view : scan.views) {
    sensor_views.push_back({view.T_level_sensor.inverse().cast<float>(), &view.image});
  }
}

Verifier::Verifier(const PreparedScan::Data& source, const PreparedScan::Data& target, std::size_t samples)
    : source_(source, samples), target_(target, samples) {}

/// What the other scan says of one point, moved into its levelled frame.
OverlapStatistics Verifier::count(const Eigen::Vector3f& moved, const Side& to) {
  OverlapStatistics v;
  if (to.map->nearest(moved, kMet) != nullptr) {
    v.overlap = 1.0;
    return v;
  }
  const auto sight = look_from_all(to.sensor_views, moved);
  if (sight == RangeImage::Sight::kAgrees) {
    (surface_runs_on(*to.coarse, moved) ? v.occluded_gap : v.missing) = 1.0;
  }
  v.free_space_violation = sight >= RangeImage::Sight::kFreeSpaceViolation ? 1.0 : 0.0;
  v.strong_violation = sight == RangeImage::Sight::kStrongViolation ? 1.0 : 0.0;
  return v;
}

VerificationStatistics Verifier::count(const Side& from, const Side& to, const Pose& T_to_from) {
  const Eigen::Isometry3f T = T_to_from.cast<float>();
  VerificationStatistics t;
  search::VoxelTable squares(256);
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < from.structure.size(); ++i) {
    const surfels::Surfel& surfel = from.structure[i];
    const Eigen::Vector3f p = T * surfel.mean;
    const OverlapStatistics statistics = from.sample_weight * count(p, to);
    const bool tall = surfel.height > kTall;
    t.structure += from.sample_weight;
    (tall ? t.tall : t.low) += statistics;
    t.objects += from.is_object[i] ? statistics : OverlapStatistics();
    t.far += surfel.mean.norm() > kFar && p.norm() > kFar ? statistics : OverlapStatistics();
    const std::uint32_t square = squares.insert(search::voxel_of({p.x(), p.y(), 0.0F}, 1.0F / kCell));
    cells.resize(squares.size());
    cells[square].all += statistics;
    cells[square].tall += tall ? statistics : OverlapStatistics();
  }
  for (const Cell& cell : cells) {
    t.contradicted +=
        cell.all.free_space_violation >= kFewInCell && cell.all.free_space_violation > 2.0 * cell.all.overlap ? 1.0
                                                                                                              : 0.0;
    t.tall_contradicted +=
        cell.tall.strong_violation >= kFewInCell && cell.tall.strong_violation > 2.0 * cell.tall.overlap ? 1.0 : 0.0;
  }
  count_ground(from, to, T, t);
  return t;
}

/// How the ground of one scan lies on that of the other.
void Verifier::count_ground(const Side& from, const Side& to, const Eigen::Isometry3f& T, VerificationStatistics& t) {
  const double w = from.ground_sample_weight;
  for (const surfels::Surfel& surfel : from.ground) {
    const Eigen::Vector3f p = T * surfel.mean;
    const surfels::Surfel* other = to.map->nearest(p, kMet);
    if (other != nullptr && other->height < kGroundHeight) {
      t.ground += w;
      t.ground_step += w * static_cast<double>(std::min(kMostGap, std::abs(other->normal.dot(other->mean - p))));
    }
  }
}

Features Verifier::features(const Alignment& alignment, const PeakHeights& peak) const {
  const Pose& T = alignment.T_target_source;
  const VerificationStatistics a = count(source_, target_, T);
  const VerificationStatistics b = count(target_, source_, T.inverse());
  const OverlapStatistics low = a.low + b.low;
  const OverlapStatistics tall = a.tall + b.tall;
  const OverlapStatistics objects = a.objects + b.objects;
  const OverlapStatistics far = a.far + b.far;
  return {0.5 * (share(a.overlap(), a.structure) + share(b.overlap(), b.structure)),
          log_against(low.missing, low.overlap + low.occluded_gap),
          log_against(tall.strong_violation, tall.overlap),
          log_against(objects.strong_violation, objects.overlap),
          log_against(far.free_space_violation, far.overlap),
          std::log1p(a.contradicted + b.contradicted),
          std::log1p(a.tall_contradicted + b.tall_contradicted),
          alignment.residual_m,
          std::log1p(objects.overlap),
          std::min(peak.own, 60.0),
          std::clamp(std::log((peak.own + 0.1) / (peak.noise_floor + 0.1)), -1.0, 2.0),
          std::log1p(a.ground + b.ground),
          (a.ground_step + b.ground_step + 0.1 * kDoubt) / (a.ground + b.ground + kDoubt),
          std::exp(-0.1 * T.translation().norm()),
          std::log1p(std::min(source_.structure_count, target_.structure_count)),
          std::log1p(std::max(source_.structure_count, target_.structure_count)),
          std::min(source_.density_ratio, target_.density_ratio),
          std::max(source_.density_ratio, target_.density_ratio)};
}

}  // namespace loopmark::registration::internal
