// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/multi_session/inter_session_loops.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark::multi_session {
namespace {

constexpr double kSamePlaceM = 8.0;       // keyframes nearer than this are compared,
constexpr double kCheckEveryM = 10.0;     // one pair in this distance,
constexpr std::size_t kMostChecks = 24;   // at even steps
constexpr std::size_t kLeastChecks = 4;   // fewer say nothing against a joint
constexpr double kLeastAgreement = 0.35;  // of the pairs
constexpr double kAgreesP = 0.5;          // P(correct) of a pair that agrees,
constexpr double kAgreesM = 1.0;          // and how far it may move
constexpr double kAgreesDeg = 5.0;
constexpr const char* kContradicted = "the drives contradict each other elsewhere";

struct Pair {
  std::size_t source = 0;
  std::size_t target = 0;
};

/// Pairs of keyframes of two drives that the map puts at the same place, every few metres of the second drive.
std::vector<Pair> same_places(const mapping::SolvedMap& map, const std::vector<std::size_t>& drive_of,
                              const InterSessionLoop& inter_session_loop) {
  std::vector<Pair> pairs;
  double last_m = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (drive_of[k] != inter_session_loop.second || map.keyframes[k].path_m - last_m < kCheckEveryM) {
      continue;
    }
    double nearest_m = kSamePlaceM;
    Pair pair;
    for (std::size_t other = 0; other < map.keyframes.size(); ++other) {
      const double apart_m = (map.T_map_keyframe[k].translation() - map.T_map_keyframe[other].translation()).norm();
      if (drive_of[other] == inter_session_loop.first && apart_m < nearest_m &&
          map.solution.component_of[k] == map.solution.component_of[other]) {
        nearest_m = apart_m;
        pair = {k, other};
      }
    }
    if (nearest_m < kSamePlaceM) {
      pairs.push_back(pair);
      last_m = map.keyframes[k].path_m;
    }
  }
  std::vector<Pair> chosen;
  const std::size_t count = std::min(pairs.size(), kMostChecks);
  for (std::size_t i = 0; i < count; ++i) {
    chosen.push_back(pairs[i * pairs.size() / count]);
  }
  return chosen;
}

/// Compares the scans of the two drives where the map says that they saw the same.
void check(const mapping::SolvedMap& map, const std::vector<std::size_t>& drive_of,
           const mapping::KeyframeRegistrar& registrar, InterSessionLoop& inter_session_loop) {
  const std::vector<Pair> pairs = same_places(map, drive_of, inter_session_loop);
  std::vector<char> agrees(pairs.size(), 0);
  parallel_for(pairs.size(), [&](std::size_t i) {
    const Pose claimed = map.T_map_keyframe[pairs[i].target].inverse() * map.T_map_keyframe[pairs[i].source];
    const registration::RegistrationResult result = registrar.verify(pairs[i].source, pairs[i].target, claimed);
    const PoseError moved = pose_error(result.T_target_source, claimed);
    agrees[i] = result.p_correct >= kAgreesP && moved.translation_m < kAgreesM && moved.rotation_deg < kAgreesDeg;
  });
  inter_session_loop.checked = pairs.size();
  inter_session_loop.agree = static_cast<std::size_t>(std::count(agrees.begin(), agrees.end(), 1));
  inter_session_loop.contradicted =
      inter_session_loop.checked >= kLeastChecks &&
      static_cast<double>(inter_session_loop.agree) < kLeastAgreement * static_cast<double>(inter_session_loop.checked);
}

using DrivePair = std::pair<std::size_t, std::size_t>;

DrivePair drives_of(const map_store::LoopRecord& loop, const std::vector<std::size_t>& drive_of) {
  return std::minmax(drive_of[loop.source], drive_of[loop.target]);
}

/// Every pair of drives with what was tried between them.
std::map<DrivePair, InterSessionLoop> count_loops(const SessionSet& set, const mapping::SolvedMap& map,
                                                  const std::vector<std::size_t>& drive_of) {
  std::map<DrivePair, InterSessionLoop> inter_session_loops;
  for (std::size_t second = 1; second < set.drives.size(); ++second) {
    for (std::size_t first = 0; first < second; ++first) {
      inter_session_loops[{first, second}].first = first;
      inter_session_loops[{first, second}].second = second;
    }
  }
  for (std::size_t i = 0; i < set.loops.size(); ++i) {
    const DrivePair pair = drives_of(set.loops[i], drive_of);
    if (pair.first == pair.second) {
      continue;
    }
    InterSessionLoop& inter_session_loop = inter_session_loops[pair];
    ++inter_session_loop.candidates;
    inter_session_loop.best_p = std::max(inter_session_loop.best_p, set.loops[i].p_correct);
    inter_session_loop.accepted += map.loops[i].accepted ? 1 : 0;
  }
  return inter_session_loops;
}

/// The component that holds keyframes of most drives, then of most keyframes.
std::size_t most_drives(const SessionSet& set, const mapping::SolvedMap& map,
                        const std::vector<std::size_t>& drive_of) {
  std::size_t best = 0;
  std::size_t most = 0;
  for (std::size_t c = 0; c < map.components; ++c) {
    std::vector<bool> in(set.drives.size(), false);
    for (const std::size_t node : map.solution.components[c].nodes) {
      in[drive_of[node]] = true;
    }
    const auto drives = static_cast<std::size_t>(std::count(in.begin(), in.end(), true));
    if (drives > most) {
      most = drives;
      best = c;
    }
  }
  return best;
}

std::string why_apart(std::size_t drive, const std::vector<InterSessionLoop>& inter_session_loops,
                      const mapping::SlamOptions& options, std::size_t min_links) {
  InterSessionLoop all;
  bool contradicted = false;
  for (const InterSessionLoop& inter_session_loop : inter_session_loops) {
    if (inter_session_loop.first == drive || inter_session_loop.second == drive) {
      all.candidates += inter_session_loop.candidates;
      all.best_p = std::max(all.best_p, inter_session_loop.best_p);
      all.checked += inter_session_loop.contradicted ? inter_session_loop.checked : 0;
      all.agree += inter_session_loop.contradicted ? inter_session_loop.agree : 0;
      contradicted = contradicted || inter_session_loop.contradicted;
    }
  }
  if (contradicted) {
    return format_text(
        "of %zu places that it would share with the others, only %zu look the same (at least %.0f %% must)",
        all.checked, all.agree, 100.0 * kLeastAgreement);
  }
  return format_text(
      "of %zu pairs of places tried with the others, the best has P(correct) %.2f; %zu that agree are needed "
      "at %.2f",
      all.candidates, all.best_p, min_links, options.min_loop_p);
}

/// Solves and compares, and withdraws loops between drives that contradict each other, until none do.
class Joiner {
 public:
  Joiner(JoinedDrives& joined, const map_store::RunFolder& folder, const mapping::SlamOptions& options,
         const pose_graph::PoseGraphOptions& graph_options, const registration::PairRegistration& registrar)
      : joined_(joined),
        options_(options),
        graph_options_(graph_options),
        drive_of_(joined.set.session_of_keyframe()),
        keyframes_(mapping::keyframes_of(joined.set.scans)),
        registrar_(folder, keyframes_, registrar) {}

  bool different_drives(std::size_t a, std::size_t b) const { return drive_of_[a] != drive_of_[b]; }

  void flush_pending() {
    do {
      check_interrupt();
      joined_.map =
          mapping::solve_keyframes(keyframes_, joined_.set.loops, options_, graph_options_, joined_.set.decisions);
    } while (finds_contradictions());
    judge();
  }

 private:
  bool finds_contradictions() {
    joined_.inter_session_loops.clear();
    const std::size_t known = refused_.size();
    for (auto& [drives, inter_session_loop] : count_loops(joined_.set, joined_.map, drive_of_)) {
      if (const auto before = refused_.find(drives); before != refused_.end()) {
        inter_session_loop = before->second;
      } else if (inter_session_loop.accepted > 0) {
        check(joined_.map, drive_of_, registrar_, inter_session_loop);
      }
      if (inter_session_loop.contradicted) {
        refused_.emplace(drives, inter_session_loop);
      }
      joined_.inter_session_loops.push_back(inter_session_loop);
    }
    for (map_store::LoopRecord& loop : joined_.set.loops) {
      if (loop.answered && refused_.count(drives_of(loop, drive_of_)) > 0) {
        loop.answered = false;
        loop.reason = kContradicted;
      }
    }
    return refused_.size() > known;
  }

  void judge() {
    const std::size_t main = most_drives(joined_.set, joined_.map, drive_of_);
    joined_.verdicts.resize(joined_.set.drives.size());
    for (std::size_t k = 0; k < keyframes_.size(); ++k) {
      DriveVerdict& verdict = joined_.verdicts[drive_of_[k]];
      ++verdict.keyframes;
      verdict.in_map += joined_.map.solution.component_of[k] == main ? 1 : 0;
    }
    for (std::size_t d = 0; d < joined_.verdicts.size(); ++d) {
      joined_.verdicts[d].belongs = joined_.verdicts[d].in_map > 0;
      if (!joined_.verdicts[d].belongs) {
        joined_.verdicts[d].reason = why_apart(d, joined_.inter_session_loops, options_, graph_options_.min_links);
      }
    }
  }

  JoinedDrives& joined_;
  mapping::SlamOptions options_;
  pose_graph::PoseGraphOptions graph_options_;
  std::vector<std::size_t> drive_of_;
  std::vector<mapping::Keyframe> keyframes_;
  mapping::KeyframeRegistrar registrar_;
  std::map<DrivePair, InterSessionLoop> refused_;
};

}  // namespace

JoinedDrives join_sessions(SessionSet set, const map_store::RunFolder& folder, const mapping::SlamOptions& options,
                           const pose_graph::PoseGraphOptions& graph_options,
                           const registration::PairRegistration& registrar, const mapping::LoopCloser::Report& report) {
  JoinedDrives joined{std::move(set), {}, {}, {}};
  Joiner joiner(joined, folder, options, graph_options, registrar);
  const mapping::LoopCloser closer(
      folder, options, graph_options, registrar,
      {false, [&](std::size_t a, std::size_t b) { return joiner.different_drives(a, b); }});
  closer.close(
      joined.set.scans, joined.set.loops, joined.set.loops.size(), [](const map_store::LoopRecord&) {}, report);
  joiner.flush_pending();
  return joined;
}

}  // namespace loopmark::multi_session
