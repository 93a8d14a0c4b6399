// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/loops_run.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/map_export/products.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/mapping/loop_closer.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/merge_run.hpp"
#include "pair_registration.hpp"

namespace loopmark::workflows {
namespace fs = std::filesystem;
namespace {

/// The candidate nearest to a pair, as a hint; empty where there is none.
std::string nearest_candidate(const OpenedRun& run, const std::vector<mapping::Keyframe>& keyframes,
                              const KeyframePair& pair) {
  const auto apart = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
  const map_store::LoopRecord* nearest = nullptr;
  for (const map_store::LoopRecord& loop : run.loops) {
    const auto distance = [&](const map_store::LoopRecord& l) {
      return apart(l.source, pair.source) + apart(l.target, pair.target);
    };
    if (nearest == nullptr || distance(loop) < distance(*nearest)) {
      nearest = &loop;
    }
  }
  return nearest == nullptr ? "the run has no candidates"
                            : "the nearest candidate is " + std::to_string(keyframes[nearest->source].scan) + "-" +
                                  std::to_string(keyframes[nearest->target].scan);
}

void decide(OpenedRun& run, const KeyframePair& pair, map_store::LoopOverride loop_override) {
  std::erase_if(run.decisions,
                [&](const map_store::LoopDecision& d) { return d.source == pair.source && d.target == pair.target; });
  run.decisions.push_back({pair.source, pair.target, loop_override});
}

void veto(OpenedRun& run, const std::vector<mapping::Keyframe>& keyframes, const std::string& text) {
  const KeyframePair pair = pair_named(text, run, keyframes);
  if (loop_of(run, pair) == run.loops.size()) {
    throw InputError(run.folder.name().string(), text, "is no loop candidate, so there is nothing to veto",
                     nearest_candidate(run, keyframes, pair));
  }
  decide(run, pair, map_store::LoopOverride::kVeto);
}

map_store::LoopRecord registered(const OpenedRun& run, const std::vector<mapping::Keyframe>& keyframes,
                                 const KeyframePair& pair) {
  const auto registrar = internal::pair_registration_of(run.options);
  map_store::LoopRecord loop;
  loop.source = pair.source;
  loop.target = pair.target;
  loop.origin = "person";
  mapping::store_result(mapping::KeyframeRegistrar(run.folder, keyframes, *registrar).scans(pair.source, pair.target),
                        loop);
  return loop;
}

void force(OpenedRun& run, const std::vector<mapping::Keyframe>& keyframes, const std::string& text) {
  const KeyframePair pair = pair_named(text, run, keyframes);
  const std::size_t known = loop_of(run, pair);
  const map_store::LoopRecord loop = known < run.loops.size() ? run.loops[known] : registered(run, keyframes, pair);
  if (loop.evidence.empty()) {
    throw InputError(run.folder.name().string(), text,
                     "registration finds no motion between these scans (" + loop.reason + ")",
                     "force a pair that sees more of the same place");
  }
  if (known == run.loops.size()) {
    run.loops.push_back(loop);
  }
  decide(run, pair, map_store::LoopOverride::kForce);
}

void forget(OpenedRun& run, const std::vector<mapping::Keyframe>& keyframes, const std::string& text) {
  const KeyframePair pair = pair_named(text, run, keyframes);
  if (!map_store::loop_override_of(run.decisions, pair.source, pair.target)) {
    throw InputError(run.folder.name().string(), text, "nobody has decided anything about this loop");
  }
  std::erase_if(run.decisions,
                [&](const map_store::LoopDecision& d) { return d.source == pair.source && d.target == pair.target; });
  std::erase_if(run.loops, [&](const map_store::LoopRecord& loop) {
    return loop.source == pair.source && loop.target == pair.target && loop.origin == "person";
  });
}

/// Keyframes as hard links (copies where the file system has none), which nobody ever writes into; records as copies.
void share_files(const fs::path& from, const fs::path& to) {
  fs::create_directories(to / "keyframes");
  for (const fs::directory_entry& file : fs::directory_iterator(from / "keyframes")) {
    std::error_code error;
    fs::create_hard_link(file.path(), to / "keyframes" / file.path().filename(), error);
    if (error) {
      fs::copy_file(file.path(), to / "keyframes" / file.path().filename());
    }
  }
  fs::copy(from / "records", to / "records", fs::copy_options::overwrite_existing | fs::copy_options::recursive);
}

nlohmann::json json_file(const fs::path& path) {
  try {
    return nlohmann::json::parse(storage::read_file(path));
  } catch (const nlohmann::json::exception& problem) {
    throw InputError(path.string(), "", std::string("is damaged: ") + problem.what());
  }
}

/// The manifest of the new run: the input as it was, and the hashes of files that are shared with the old run.
map_export::Manifest manifest_of(const OpenedRun& run, const std::vector<std::string>& arguments) {
  const nlohmann::json old = json_file(run.folder / "manifest.json");
  map_export::Manifest manifest = map_export::input_of_manifest(run.folder);
  manifest.arguments = arguments;
  manifest.started = utc_now();
  const nlohmann::json hashes = old.value("sha256", nlohmann::json::object());
  for (const auto& [file, hash] : hashes.items()) {
    if (file.starts_with("keyframes/")) {
      manifest.known_sha256[file] = hash.get<std::string>();
    }
  }
  return manifest;
}

MapSummary write_all(const OpenedRun& run, const mapping::SolvedMap& map, const map_store::RunFolder& folder,
                     bool maps) {
  share_files(run.folder.path(), folder.path());
  storage::write_file_atomically(folder / "config.yaml", options_as_yaml(run.options));
  map_store::write_loop_records(folder, run.loops);
  map_store::write_loop_decisions(folder, run.decisions);
  const Stopwatch watch;
  map_export::write_trajectory_products(folder, run.scans, run.loops, map);
  if (maps) {
    map_export::write_occupancy(folder, map, run.options.occupancy);
    map_export::write_clouds(folder, map, run.options.slam.cloud_voxel_m);
    map_export::write_mrpt_products(folder, run.scans, run.loops, map);
  }
  const std::vector<Pose> truth = truth_of(run.folder, run.scans.size());
  MapTimes times = times_of(run);
  times.solving = map.solution.seconds;
  times.products = watch.seconds();
  const MapSummary summary = summary_of(run, map, truth);
  write_map_report(folder, run.scans, run.loops, map, summary, times, truth, run.options.slam.min_loop_p,
                   run.folder / "report.html");
  write_summary(folder, summary, times);
  return summary;
}

}  // namespace

MapTimes times_of(const OpenedRun& run) {
  const nlohmann::json json = json_file(run.folder / "timings.json");
  MapTimes times;
  times.reading = json.value("reading", 0.0);
  times.odometry = json.value("odometry", 0.0);
  times.loops = json.value("loops", 0.0);
  times.whole = json.value("whole", 0.0);
  return times;
}

MapSummary summary_of(const OpenedRun& run, const mapping::SolvedMap& map, const std::vector<Pose>& truth) {
  MapSummary summary = summarize(run.scans, run.loops, map, truth);
  const std::vector<multi_session::SessionRecord> drives = multi_session::read_sessions(run.folder, run.scans);
  summary.drives = drive_summaries(drives, map, truth);
  summary.duration_s = driven_s(drives, run.scans);
  summary.compensation = json_file(run.folder / "summary.json").value("compensation", "unknown");
  return summary;
}

void apply(const LoopChanges& changes, OpenedRun& run) {
  const std::vector<mapping::Keyframe> keyframes = mapping::keyframes_of(run.scans);
  std::set<std::pair<std::size_t, std::size_t>> named;
  const auto each = [&](const std::vector<std::string>& pairs, const auto& change) {
    for (const std::string& text : pairs) {
      const KeyframePair pair = pair_named(text, run, keyframes);
      if (!named.insert({pair.source, pair.target}).second) {
        throw InputError("'" + text + "' is named twice: say one thing about a loop");
      }
      change(run, keyframes, text);
    }
  };
  each(changes.forget, forget);
  each(changes.veto, veto);
  each(changes.force, force);
}

Rewritten rewrite(const OpenedRun& run, const mapping::SolvedMap& map, const fs::path& output, bool maps,
                  const std::vector<std::string>& arguments) {
  const Stopwatch watch;
  map_store::RunFolder folder =
      output.empty() ? map_store::RunFolder::revise(run.folder.path()) : map_store::RunFolder::create(output);
  Rewritten result;
  try {
    result.summary = write_all(run, map, folder, maps);
    map_export::Manifest manifest = manifest_of(run, arguments);
    manifest.seconds = watch.seconds();
    map_export::write_manifest(folder, manifest);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(folder.path(), ignored);
    throw;
  }
  if (output.empty()) {
    result.before = folder.finish_revision();
  } else {
    folder.finish();
  }
  result.run = folder.path();
  result.seconds = watch.seconds();
  return result;
}

}  // namespace loopmark::workflows
