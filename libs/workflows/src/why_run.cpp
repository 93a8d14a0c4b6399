// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/why_run.hpp"

#include <algorithm>
#include <cstdio>

#include "loopmark/core/number_text.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/mapping/loop_closer.hpp"
#include "loopmark/registration/evidence_text.hpp"
#include "loopmark/report/picture.hpp"
#include "pair_registration.hpp"

namespace loopmark::workflows {
namespace {

std::string proposal_text(const OpenedRun& run, const mapping::SolvedMap& map, const Verifier& q) {
  const mapping::SlamOptions& o = run.options.slam;
  std::string text = "1 proposed    ";
  if (q.loop) {
    text += "yes, by: " + run.loops[*q.loop].origin + "\n";
  } else if (!q.place) {
    text += format_text("no: only %.1f m of driving apart, no loop within %.1f m (slam.loop_gap_m)\n",
                        map.keyframes[q.pair.source].path_m - map.keyframes[q.pair.target].path_m, o.loop_gap_m);
  } else if (!q.looked_up) {
    text += format_text("no: for k%zu no place was looked up (once in %.1f m: slam.loop_every_m)\n", q.pair.source,
                        o.loop_every_m);
  } else {
    text += format_text("no: not among the %zu most alike places (slam.loop_candidates)\n", o.loop_candidates);
  }
  if (q.place) {
    text += format_text(
        "              alike as number %zu of %zu places; descriptors differ by %.3f, the most alike by %.3f\n",
        q.place->rank, q.place->places, q.place->distance, q.place->best_distance);
  }
  return text;
}

std::string mode_text(std::size_t number, const registration::RegistrationMode& mode) {
  const Eigen::Vector3d at = mode.T_target_source.translation();
  return format_text("  mode %zu      P %.3f at %.2f %.2f %.2f m, yaw %.1f deg (%s)\n", number, mode.p_correct, at.x(),
                     at.y(), at.z(), euler_degrees(mode.T_target_source.linear()).z(), mode.origin.c_str());
}

std::string registration_stage(const OpenedRun& run, const Verifier& q) {
  const registration::RegistrationResult& r = q.registration;
  std::string text = "2 registered  ";
  if (q.loop) {
    const map_store::LoopRecord& loop = run.loops[*q.loop];
    text += format_text("P(correct) %.3f on record, at least %.3f is needed (slam.min_loop_p)", loop.p_correct,
                        run.options.slam.min_loop_p);
    text += loop.answered ? "\n" : "; no answer: " + loop.reason + "\n";
    const PoseError change = pose_error(r.T_target_source, loop.T_target_source);
    text += format_text("              again now: P(correct) %.3f, %.3f m and %.2f deg from the record\n", r.p_correct,
                        change.translation_m, change.rotation_deg);
  } else {
    text += format_text("not when the map was made; now: P(correct) %.3f%s%s\n", r.p_correct,
                        r.answered ? "" : "; no answer: ", r.reason.c_str());
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(r.modes.size(), 3); ++i) {
    text += mode_text(i + 1, r.modes[i]);
  }
  return text + registration::evidence_table(r.modes, 3);
}

std::string graph_stage(const OpenedRun& run, const mapping::SolvedMap& map, const Verifier& q) {
  std::string text = "3 pose graph  ";
  if (!q.loop || !map.loops[*q.loop].edge) {
    text += "took no part\n";
  } else {
    const pose_graph::EdgeReport& edge = map.solution.edges[*map.loops[*q.loop].edge];
    text +=
        format_text("%s: weight %.2f, chi2 %.1f (limit %.1f), agrees with %zu of the %zu other loops of its group\n",
                    to_string(edge.verdict).c_str(), edge.weight, edge.chi2, run.options.pose_graph.inlier_chi2,
                    edge.agrees_with, edge.group_size > 0 ? edge.group_size - 1 : 0);
  }
  const std::size_t source = q.pair.source;
  const std::size_t target = q.pair.target;
  if (map.solution.component_of[source] != map.solution.component_of[target]) {
    return text + "              the keyframes are in components that nothing joins\n";
  }
  const Pose in_map = map.T_map_keyframe[target].inverse() * map.T_map_keyframe[source];
  text += format_text("              in the map the source is %.2f m from the target", in_map.translation().norm());
  if (!q.registration.modes.empty()) {
    const PoseError error = pose_error(q.registration.T_target_source, in_map);
    text +=
        format_text("; registration puts it %.2f m and %.2f deg from there", error.translation_m, error.rotation_deg);
  }
  return text + "\n";
}

std::string verdict_text(const mapping::SolvedMap& map, const Verifier& q) {
  if (!q.loop) {
    return "verdict       never a candidate\n";
  }
  const mapping::LoopVerdict& verdict = map.loops[*q.loop];
  const std::string word = verdict.accepted ? "accepted" : "rejected";
  return "verdict       " + (verdict.reason.empty() ? word : word + ": " + verdict.reason) + "\n";
}

}  // namespace

Verifier inquire(const OpenedRun& run, const mapping::SolvedMap& map, const KeyframePair& pair) {
  Verifier q;
  q.pair = pair;
  q.place = localization::place_rank(run.folder, map.keyframes, pair.source, pair.target, run.options.slam.loop_gap_m);
  q.looked_up = std::any_of(run.loops.begin(), run.loops.end(), [&](const map_store::LoopRecord& loop) {
    return loop.source == pair.source && loop.origin == "place";
  });
  const std::size_t loop = loop_of(run, pair);
  if (loop < run.loops.size()) {
    q.loop = loop;
  }
  const auto registrar = internal::pair_registration_of(run.options);
  const mapping::KeyframeRegistrar pairs(run.folder, map.keyframes, *registrar);
  q.registration = q.loop && run.loops[*q.loop].origin == mapping::kSubmapOrigin
                       ? pairs.submaps(pair.source, pair.target, run.options.slam.submap_keyframes)
                       : pairs.scans(pair.source, pair.target);
  return q;
}

std::string inquiry_text(const OpenedRun& run, const mapping::SolvedMap& map, const Verifier& q) {
  const mapping::Keyframe& source = map.keyframes[q.pair.source];
  const mapping::Keyframe& target = map.keyframes[q.pair.target];
  std::string text = format_text(
      "source        scan %zu, keyframe k%zu\ntarget        scan %zu, keyframe k%zu, %.1f m of driving before\n",
      source.scan, source.number, target.scan, target.number, source.path_m - target.path_m);
  return text + proposal_text(run, map, q) + registration_stage(run, q) + graph_stage(run, map, q) +
         verdict_text(map, q);
}

void write_inquiry_picture(const OpenedRun& run, const Verifier& q, const std::filesystem::path& path) {
  const auto points = [&](std::size_t keyframe) {
    return io::read_point_file(run.folder.keyframe(keyframe, "pcd")).cloud.points;
  };
  const Pose motion = q.loop ? run.loops[*q.loop].T_target_source : q.registration.T_target_source;
  report::write_png(path, report::registration_picture(points(q.pair.source), points(q.pair.target), motion));
}

}  // namespace loopmark::workflows
