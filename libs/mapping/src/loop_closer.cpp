// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/places/place_index.hpp"

namespace loopmark::mapping {
namespace {

constexpr std::size_t kSegmentNeighbours = 3;  // keyframes before a new segment that its first keyframes are tried with
constexpr std::size_t kRounds = 4;             // of submaps, each only while the one before has joined something

map_store::LoopRecord candidate(std::size_t a, std::size_t b, const char* origin) {
  map_store::LoopRecord record;
  record.source = std::max(a, b);
  record.target = std::min(a, b);
  record.origin = origin;
  return record;
}

/// Says of each keyframe in order whether its place is to be looked up: the first of a segment, then every few metres.
class DistanceTrigger {
 public:
  explicit DistanceTrigger(double every_m) : every_m_(every_m) {}
  bool due(const Keyframe& keyframe) {
    const bool due = !started_ || keyframe.segment != segment_ || keyframe.path_m - last_m_ >= every_m_;
    if (due) {
      started_ = true;
      segment_ = keyframe.segment;
      last_m_ = keyframe.path_m;
    }
    return due;
  }

 private:
  double every_m_;
  bool started_ = false;
  std::size_t segment_ = 0;
  double last_m_ = 0.0;
};

using Pairs = std::set<std::pair<std::size_t, std::size_t>>;

/// A pair is tried once, as scans or as submaps: a person's decision about it must mean one thing.
Pairs pairs_of(const std::vector<map_store::LoopRecord>& loops) {
  Pairs pairs;
  for (const map_store::LoopRecord& loop : loops) {
    pairs.insert({loop.source, loop.target});
  }
  return pairs;
}

std::vector<map_store::LoopRecord> first_of(const std::vector<map_store::LoopRecord>& loops, std::size_t count) {
  return {loops.begin(), loops.begin() + static_cast<std::ptrdiff_t>(count)};
}

/// A pair of places by how alike they are; the order makes ties repeatable.
using Alike = std::tuple<double, std::size_t, std::size_t>;

/// The most alike pairs that were not tried, no two with the same or neighbouring first keyframes.
std::vector<map_store::LoopRecord> most_alike(std::vector<Alike> pairs, std::size_t count, const Pairs& tried) {
  constexpr std::size_t kApart = 2;
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::size_t> taken;
  std::vector<map_store::LoopRecord> chosen;
  for (const auto& [distance, k, other] : pairs) {
    const map_store::LoopRecord record = candidate(k, other, kSubmapOrigin);
    const bool near = std::any_of(taken.begin(), taken.end(),
                                  [at = k](std::size_t t) { return (t > at ? t - at : at - t) < kApart; });
    if (!near && chosen.size() < count && tried.count({record.source, record.target}) == 0) {
      chosen.push_back(record);
      taken.push_back(k);
    }
  }
  return chosen;
}

/// The ends of segments that follow each other in different components, as the drive went from one to the other: pairs
/// around those that were tried as scans.
void add_ends(const SolvedMap& map, const Pairs& tried, std::vector<map_store::LoopRecord>& todo) {
  for (std::size_t k = 1; k < map.keyframes.size(); ++k) {
    if (map.keyframes[k].segment == map.keyframes[k - 1].segment ||
        map.solution.component_of[k] == map.solution.component_of[k - 1]) {
      continue;
    }
    for (const auto& [ahead, back] : {std::pair(1, 3), std::pair(2, 2), std::pair(2, 3)}) {
      const std::size_t a = k + static_cast<std::size_t>(ahead);
      const std::size_t b = k - std::min(k, static_cast<std::size_t>(back));
      const bool fits = a < map.keyframes.size() && map.keyframes[a].segment == map.keyframes[k].segment &&
                        map.keyframes[b].segment == map.keyframes[k - 1].segment;
      if (fits && tried.count({a, b}) == 0) {
        todo.push_back(candidate(a, b, kSubmapOrigin));
      }
    }
  }
}

}  // namespace

/// Loops as they are found; `known` of them count as given for what comes next.
struct LoopCloser::Work {
  const std::vector<Keyframe>& keyframes;
  std::vector<map_store::LoopRecord>& loops;
  std::size_t known = 0;
  const Keep& keep;
  const Report& report;
  std::size_t given = 0;
};

LoopCloser::LoopCloser(const map_store::RunFolder& folder, const SlamOptions& options,
                       const pose_graph::PoseGraphOptions& graph_options,
                       const registration::PairRegistration& registrar, LoopScope scope)
    : folder_(folder),
      options_(options),
      graph_options_(graph_options),
      registrar_(registrar),
      scope_(std::move(scope)) {}

bool LoopCloser::may_join(const Keyframe& source, const Keyframe& target) const {
  return source.segment != target.segment
             ? !scope_.may_join || scope_.may_join(source.number, target.number)
             : !scope_.may_join && (source.path_m < target.path_m ? is_revisit(source, target, options_.loop_gap_m)
                                                                  : is_revisit(target, source, options_.loop_gap_m));
}

/// Places that look alike, and for the first keyframes of a segment the last ones of the segments before.
std::vector<map_store::LoopRecord> LoopCloser::places(const std::vector<Keyframe>& keyframes) const {
  std::vector<map_store::LoopRecord> todo;
  places::PlaceIndex index;
  DistanceTrigger lookup(options_.loop_every_m);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    std::set<std::size_t> tried;
    const auto add = [&](std::size_t target, const char* origin) {
      if (tried.insert(target).second) {
        todo.push_back(candidate(k, target, origin));
      }
    };
    for (std::size_t back = 1; scope_.neighbours && back <= kSegmentNeighbours && back <= k; ++back) {
      if (keyframes[k - back].segment != keyframes[k].segment) {
        add(k - back, "neighbour");
      }
    }
    const places::PlaceDescriptor descriptor = map_store::read_keyframe_place(folder_, k);
    const auto apart = [&](std::size_t earlier) { return may_join(keyframes[k], keyframes[earlier]); };
    const std::size_t count = lookup.due(keyframes[k]) ? options_.loop_candidates : 0;
    for (const places::PlaceMatch& match : index.query(descriptor, count, apart)) {
      add(match.id, "place");
    }
    index.add(k, descriptor);
  }
  return todo;
}

/// For every component but the first: the places of the others that its own are most alike, and where the drive went
/// from one component to another.
std::vector<map_store::LoopRecord> LoopCloser::between_components(
    const SolvedMap& map, const std::vector<map_store::LoopRecord>& tried) const {
  const std::vector<Keyframe>& keyframes = map.keyframes;
  std::vector<places::PlaceDescriptor> descriptors;
  places::PlaceIndex index;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    descriptors.push_back(map_store::read_keyframe_place(folder_, k));
    index.add(k, descriptors.back());
  }
  const Pairs before = pairs_of(tried);
  std::vector<map_store::LoopRecord> todo;
  for (std::size_t c = 1; c < map.components; ++c) {
    std::vector<Alike> pairs;
    DistanceTrigger lookup(options_.keyframe_m);
    for (const std::size_t k : map.solution.components[c].nodes) {
      const auto elsewhere = [&](std::size_t other) {
        return map.solution.component_of[other] != c && may_join(keyframes[k], keyframes[other]);
      };
      for (const places::PlaceMatch& match :
           index.query(descriptors[k], lookup.due(keyframes[k]) ? options_.loop_candidates : 0, elsewhere)) {
        pairs.emplace_back(match.distance, k, match.id);
      }
    }
    const std::vector<map_store::LoopRecord> best = most_alike(std::move(pairs), options_.segment_candidates, before);
    todo.insert(todo.end(), best.begin(), best.end());
  }
  if (scope_.neighbours) {
    add_ends(map, before, todo);
  }
  Pairs chosen;
  std::erase_if(todo, [&](const map_store::LoopRecord& record) {
    return !chosen.insert({record.source, record.target}).second;
  });
  return todo;
}

/// Tries the candidates behind those that are on record already, in batches on all threads.
void LoopCloser::attempt(Work& work, std::vector<map_store::LoopRecord> todo) const {
  constexpr std::size_t kBatch = 8;  // between two looks at the interrupt flag
  const KeyframeRegistrar registrar(folder_, work.keyframes, registrar_);
  const auto tried = [&](map_store::LoopRecord record) {
    const registration::RegistrationResult result =
        record.origin == kSubmapOrigin ? registrar.submaps(record.source, record.target, options_.submap_keyframes)
                                       : registrar.scans(record.source, record.target);
    store_result(result, record);
    return record;
  };
  for (std::size_t done = std::min(work.loops.size() - work.known, todo.size()); done < todo.size();) {
    check_interrupt();
    const std::size_t batch = std::min(kBatch, todo.size() - done);
    parallel_for(batch, [&](std::size_t i) { todo[done + i] = tried(todo[done + i]); });
    for (std::size_t i = 0; i < batch; ++i, ++done) {
      work.keep(todo[done]);
      work.loops.push_back(todo[done]);
    }
    if (work.report) {
      work.report(work.known - work.given + done, work.known - work.given + todo.size());
    }
  }
  work.known += todo.size();
}

void LoopCloser::close(const std::vector<map_store::ScanRecord>& scans, std::vector<map_store::LoopRecord>& loops,
                       std::size_t given, const Keep& keep, const Report& report) const {
  const std::vector<Keyframe> keyframes = keyframes_of(scans);
  Work work{keyframes, loops, given, keep, report, given};
  // Candidates follow from what was known before them alone, so that those on record are the first ones.
  std::vector<map_store::LoopRecord> todo = places(keyframes);
  const Pairs before = pairs_of(first_of(loops, given));
  std::erase_if(todo, [&](const map_store::LoopRecord& record) {
    return before.count({record.source, record.target}) > 0;
  });
  attempt(work, std::move(todo));
  for (std::size_t round = 0, components = keyframes.size() + 1; round < kRounds; ++round) {
    const std::vector<map_store::LoopRecord> known = first_of(loops, work.known);
    const SolvedMap map = solve_keyframes(keyframes, known, options_, graph_options_);
    if (map.components == 1 || map.components >= components) {
      return;
    }
    components = map.components;
    attempt(work, between_components(map, known));
  }
}

}  // namespace loopmark::mapping
