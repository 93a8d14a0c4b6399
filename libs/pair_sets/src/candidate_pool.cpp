// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pair_sets/candidate_pool.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>

#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/storage/files.hpp"
#include "overlap_probe.hpp"
#include "pool_records.hpp"

namespace loopmark::pair_sets {
namespace {

/// Sources of one block follow each other, so that the spacing of one helps the next; blocks are independent.
constexpr std::size_t kBlock = 8;

struct Source {
  std::size_t drive = 0;
  std::size_t place = 0;
};

std::vector<Source> sources_of(const std::vector<Drive>& drives, std::size_t spacing) {
  std::vector<Source> sources;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    for (std::size_t place = 0; place < drives[d].size(); place += spacing) {
      sources.push_back({d, place});
    }
  }
  return sources;
}

/// The last frame that is at most max_gap_s after the source.
std::size_t last_in_time(const Drive& drive, std::size_t place, double max_gap_s) {
  const double end = drive.stamps_s[place] + max_gap_s;
  const auto after =
      std::upper_bound(drive.stamps_s.begin() + static_cast<std::ptrdiff_t>(place), drive.stamps_s.end(), end);
  return static_cast<std::size_t>(after - drive.stamps_s.begin()) - 1;
}

/// The search for the farthest target of one source.
class FarthestSearch {
 public:
  FarthestSearch(const Drive& drive, std::size_t place, const BalanceOptions& options, PoolCost& cost)
      : drive_(drive),
        place_(place),
        options_(options),
        probe_(drive, place, cost),
        good_(place),
        bad_(last_in_time(drive, place, options.max_gap_s) + 1) {}

  /// Narrows [good, bad) to neighbours, starting `guess` frames ahead; the source itself when no target is good.
  std::size_t farthest(std::size_t guess) {
    std::size_t next = guess == 0 ? middle() : std::clamp(place_ + guess, good_ + 1, bad_ - 1);
    while (bad_ - good_ > 1) {
      (enough(next) ? good_ : bad_) = next;
      next = middle();
    }
    return good_;
  }

  /// A target drawn uniformly from (source, farthest]; frames in between that see too little are drawn again.
  std::optional<RegistrationPair> draw(std::size_t farthest, Rng& rng) {
    if (farthest == place_) {
      return std::nullopt;
    }
    constexpr int kDraws = 8;
    std::size_t target = farthest;
    for (int i = 0; i < kDraws; ++i) {
      target = place_ + 1 + rng.below(static_cast<std::uint32_t>(farthest - place_));
      if (enough(target)) {
        return probe_.pair(drive_, target, overlap_at(target));
      }
    }
    return probe_.pair(drive_, farthest, overlap_at(farthest));
  }

 private:
  std::size_t middle() const { return good_ + (bad_ - good_) / 2; }
  bool enough(std::size_t target) { return internal::chosen(overlap_at(target), options_) >= options_.min_overlap; }
  cloud::Overlap overlap_at(std::size_t target) {
    const auto known = known_.find(target);
    return known != known_.end() ? known->second : known_[target] = probe_.with(drive_, target);
  }

  const Drive& drive_;
  std::size_t place_;
  const BalanceOptions& options_;
  internal::OverlapProbe probe_;
  std::size_t good_, bad_;
  std::map<std::size_t, cloud::Overlap> known_;
};

std::vector<RegistrationPair> block_of_candidates(const std::vector<Drive>& drives, const std::vector<Source>& sources,
                                                  std::size_t block, const BalanceOptions& options, PoolCost& cost) {
  std::vector<RegistrationPair> candidates;
  std::size_t guess = 0;
  const std::size_t end = std::min(sources.size(), (block + 1) * kBlock);
  for (std::size_t i = block * kBlock; i < end; ++i) {
    check_interrupt();
    const Drive& drive = drives[sources[i].drive];
    const bool same_drive = i > block * kBlock && sources[i - 1].drive == sources[i].drive;
    Rng rng(task_seed(options.seed, {0x706f6f6cU, static_cast<std::uint64_t>(drive.session), sources[i].place}));
    FarthestSearch search(drive, sources[i].place, options, cost);
    const std::size_t farthest = search.farthest(same_drive ? guess : 0);
    guess = farthest - sources[i].place;
    if (const auto pair = search.draw(farthest, rng)) {
      candidates.push_back(*pair);
    }
  }
  return candidates;
}

}  // namespace

void check(const BalanceOptions& options) {
  require_option(options.min_overlap > 0.0 && options.min_overlap <= 1.0, "min_overlap", "must be in (0, 1]");
  require_option(options.radius > 0.0, "radius", "must be above 0");
  require_option(options.candidates_per_pair >= 1, "candidates_per_pair", "must be at least 1");
  require_option(options.max_gap_s > 0.0, "max_gap_s", "must be above 0");
}

void check(const Drive& drive) {
  if (drive.T_world_cloud.size() != drive.size() || drive.size() == 0) {
    throw InputError(drive.name, "",
                     "no reference pose for every scan (" + std::to_string(drive.T_world_cloud.size()) + " poses, " +
                         std::to_string(drive.size()) + " scans)",
                     "balanced sets need poses: put poses.txt into the log, or map it first");
  }
  for (std::size_t i = 1; i < drive.size(); ++i) {
    if (!(drive.stamps_s[i] >= drive.stamps_s[i - 1])) {
      throw InputError(drive.name, "scan " + std::to_string(i), "the times go back", "sort the scans by time");
    }
  }
}

std::size_t source_spacing(const std::vector<Drive>& drives, std::size_t pairs, const BalanceOptions& options) {
  std::size_t frames = 0;
  for (const Drive& drive : drives) {
    frames += drive.size();
  }
  return std::max<std::size_t>(1, frames / std::max<std::size_t>(1, options.candidates_per_pair * pairs));
}

std::vector<RegistrationPair> make_candidate_pool(const std::vector<Drive>& drives, std::size_t pairs,
                                                  const BalanceOptions& options, const std::filesystem::path& records,
                                                  PoolCost* cost) {
  check(options);
  const Stopwatch watch;
  const std::size_t spacing = source_spacing(drives, pairs, options);
  const std::vector<Source> sources = sources_of(drives, spacing);
  const std::size_t blocks = (sources.size() + kBlock - 1) / kBlock;
  internal::PoolRecords done(records, drives, spacing, options);
  Progress progress("pool", "sources", sources.size());
  PoolCost total;
  std::mutex mutex;
  std::vector<std::vector<RegistrationPair>> parts(blocks);
  parallel_for(blocks, [&](std::size_t block) {
    if (const auto* found = done.find(block)) {
      parts[block] = *found;
      return;
    }
    PoolCost own;
    parts[block] = block_of_candidates(drives, sources, block, options, own);
    const std::scoped_lock lock(mutex);
    done.add(block, parts[block]);
    total.overlaps += own.overlaps;
    total.scans += own.scans;
    progress.add(std::min(kBlock, sources.size() - block * kBlock));
  });
  std::vector<RegistrationPair> pool;
  for (const auto& part : parts) {
    pool.insert(pool.end(), part.begin(), part.end());
  }
  if (cost != nullptr) {
    *cost = {total.overlaps, total.scans, watch.seconds()};
  }
  return pool;
}

}  // namespace loopmark::pair_sets
