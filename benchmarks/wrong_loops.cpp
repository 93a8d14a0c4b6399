// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// wrong_loops RUN: what wrong loops among the believed candidates of a run do to its map, by how the graph is solved.
// The run must hold the truth of its scans (records/truth.tum), which serves to judge, and to make loops that are
// wrong.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "loopmark/core/progress.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/mapping/trajectory_metrics.hpp"

namespace {

using namespace loopmark;

constexpr double kShare = 0.3;  // of the believed loops are wrong

struct Run {
  std::vector<map_store::ScanRecord> scans;
  std::vector<map_store::LoopRecord> loops;
  std::vector<mapping::Keyframe> keyframes;
  std::vector<loopmark::Pose> truth;  ///< of the scans

  const loopmark::Pose& true_pose(std::size_t keyframe) const { return truth[keyframes[keyframe].scan]; }
};

std::size_t priors(const Run& run, const mapping::SlamOptions& options) {
  return static_cast<std::size_t>(std::count_if(
      run.loops.begin(), run.loops.end(),
      [&](const map_store::LoopRecord& loop) { return loop.answered && loop.p_correct >= options.min_loop_p; }));
}

map_store::LoopRecord wrong_loop(std::size_t a, std::size_t b, const loopmark::Pose& T_target_source) {
  map_store::LoopRecord loop;
  loop.source = std::max(a, b);
  loop.target = std::min(a, b);
  loop.origin = "injected";
  loop.answered = true;
  loop.p_correct = 0.97;
  loop.T_target_source = T_target_source;
  loop.covariance = 1e-4 * loopmark::Matrix6d::Identity();
  return loop;
}

/// Any two keyframes, said to be within a few metres of each other.
void inject_random(Run& run, std::size_t count, loopmark::Rng& rng) {
  const auto keyframes = static_cast<std::uint32_t>(run.keyframes.size());
  while (count > 0) {
    const std::size_t a = rng.below(keyframes);
    const std::size_t b = rng.below(keyframes);
    if (a == b || (run.true_pose(a).translation() - run.true_pose(b).translation()).norm() < 30.0) {
      continue;
    }
    run.loops.push_back(
        wrong_loop(a, b,
                   loopmark::pose_from_yaw(rng.uniform(-3.1, 3.1),
                                           {rng.uniform(-8, 8), rng.uniform(-8, 8), rng.uniform(-0.3, 0.3)})));
    --count;
  }
}

/// Two stretches that look alike: every loop says the same of how they lie to each other, with the noise of true ones.
void inject_alike(Run& run, std::size_t count, loopmark::Rng& rng) {
  const std::size_t length = std::min(count, run.keyframes.size() / 4);
  const std::size_t first = run.keyframes.size() / 10;
  const std::size_t second = run.keyframes.size() * 6 / 10;
  const loopmark::Pose alike =
      run.true_pose(first) * run.true_pose(second).inverse();  // the second stretch laid on the first
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t a = first + i % length;
    const std::size_t b = second + i % length;
    loopmark::Vector6d noise;
    for (int axis = 0; axis < 6; ++axis) {
      noise[axis] = (axis < 3 ? 0.05 : 0.002) * rng.normal();
    }
    run.loops.push_back(
        wrong_loop(a, b, loopmark::exp_se3(noise) * run.true_pose(a).inverse() * alike * run.true_pose(b)));
  }
}

void solve(const char* wrong, const Run& run, std::size_t given, bool consistency, bool robust) {
  pose_graph::PoseGraphOptions graph;
  graph.consistency_check = consistency;
  graph.robust = robust;
  const loopmark::Stopwatch watch;
  const mapping::SolvedMap map = mapping::solve_map(run.scans, run.loops, {}, graph);
  const double seconds = watch.seconds();
  std::size_t kept = 0;
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < run.loops.size(); ++i) {
    (i < given ? accepted : kept) += map.loops[i].accepted ? 1 : 0;
  }
  std::printf(
      "%-8s %-4s %-4s  ATE %8.3f m  %4zu of %4zu given loops accepted, %4zu of %4zu injected, %zu components, "
      "%.2f s\n",
      wrong, consistency ? "PCM" : "-", robust ? "GNC" : "-", mapping::absolute_error(map.T_map_scan, run.truth).rmse_m,
      accepted, given, kept, run.loops.size() - given, map.components, seconds);
}

void report(const Run& run) {
  const std::size_t given = run.loops.size();
  const std::size_t good = priors(run, {});
  const auto count = static_cast<std::size_t>(kShare / (1.0 - kShare) * static_cast<double>(good) + 0.5);
  std::printf("%zu keyframes, %zu candidates, %zu believed; %zu wrong ones are injected (%.0f %%)\n",
              run.keyframes.size(), given, good, count, 100.0 * kShare);
  Run random = run;
  Run alike = run;
  Run both = run;
  loopmark::Rng rng(1);
  inject_random(random, count, rng);
  inject_alike(alike, count, rng);
  inject_random(both, count / 2, rng);
  inject_alike(both, count - count / 2, rng);
  for (const auto& [consistency, robust] : {std::pair(true, true), {false, true}, {true, false}, {false, false}}) {
    solve("none", run, given, consistency, robust);
    solve("random", random, given, consistency, robust);
    solve("alike", alike, given, consistency, robust);
    solve("both", both, given, consistency, robust);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: wrong_loops RUN\n");
    return 2;
  }
  try {
    const map_store::RunFolder folder = map_store::RunFolder::open(argv[1]);
    map_store::RunRecords records = map_store::read_run_records(folder);
    Run run{std::move(records.scans),
            std::move(records.loops),
            {},
            io::read_trajectory(folder / "records/truth.tum").poses};
    run.keyframes = mapping::keyframes_of(run.scans);
    report(run);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  return EXIT_SUCCESS;
}
