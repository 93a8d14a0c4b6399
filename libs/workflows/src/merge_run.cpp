// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/merge_run.hpp"

#include <algorithm>

#include "loopmark/core/error.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/map_export/products.hpp"
#include "loopmark/storage/files.hpp"
#include "pair_registration.hpp"

namespace loopmark::workflows {
namespace fs = std::filesystem;
namespace {

multi_session::JoinedDrives join(const multi_session::SessionSet& set, const map_store::RunFolder& folder,
                                 const ProgramOptions& options) {
  LoopProgress progress;
  return multi_session::join_sessions(set, folder, options.slam, options.pose_graph,
                                      *internal::pair_registration_of(options),
                                      [&](std::size_t done, std::size_t total) { progress.show(done, total); });
}

void require_inter_session_loop(const multi_session::JoinedDrives& joined) {
  const auto belong = std::count_if(joined.verdicts.begin(), joined.verdicts.end(),
                                    [](const multi_session::DriveVerdict& verdict) { return verdict.belongs; });
  if (belong >= 2) {
    return;
  }
  std::string text;
  for (const multi_session::InterSessionLoop& inter_session_loop : joined.inter_session_loops) {
    text += (text.empty() ? "" : "; ") + joined.set.drives[inter_session_loop.first].name + " with " +
            joined.set.drives[inter_session_loop.second].name + ": " + std::to_string(inter_session_loop.candidates) +
            " pairs of places tried, best P(correct) " + format_text("%.2f", inter_session_loop.best_p) + ", " +
            std::to_string(inter_session_loop.accepted) + " loops";
    text += inter_session_loop.contradicted
                ? ", only " + std::to_string(inter_session_loop.agree) + " of " +
                      std::to_string(inter_session_loop.checked) + " shared places look the same"
                : "";
  }
  throw InputError("no two of the drives hang together (" + text + ")", "", "nothing is merged",
                   "drives need some hundred metres of road in common");
}

std::vector<bool> belonging(const multi_session::JoinedDrives& joined) {
  std::vector<bool> keep;
  for (const multi_session::DriveVerdict& verdict : joined.verdicts) {
    keep.push_back(verdict.belongs);
  }
  return keep;
}

/// True poses of all scans of the drives that belong; empty unless they are in one frame.
std::vector<Pose> whole_truth(const MergeInput& input, const std::vector<bool>& keep, bool one_frame) {
  std::vector<Pose> whole;
  for (std::size_t d = 0; one_frame && d < keep.size(); ++d) {
    if (keep[d]) {
      whole.insert(whole.end(), input.truth[d].begin(), input.truth[d].end());
    }
  }
  return whole;
}

void keep_truth(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                const std::vector<Pose>& truth) {
  std::vector<double> stamps_s;
  for (const map_store::ScanRecord& scan : scans) {
    stamps_s.push_back(scan.stamp_s);
  }
  if (!truth.empty()) {
    io::write_tum(truth_file(folder), stamps_s, truth);
  }
}

std::optional<mapping::AbsoluteError> error_of(const multi_session::SessionRecord& drive, const mapping::SolvedMap& map,
                                               const std::vector<Pose>& truth) {
  std::vector<Pose> found;
  std::vector<Pose> true_poses;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (map.component[drive.first_scan + i] == 0) {
      found.push_back(map.T_map_scan[drive.first_scan + i]);
      true_poses.push_back(truth[i]);
    }
  }
  return found.empty() ? std::nullopt : std::optional(mapping::absolute_error(found, true_poses));
}

/// Every drive that was given: those of the new run in their places, then those left out.
std::vector<DriveSummary> all_drives(const MergeInput& input, const multi_session::JoinedDrives& joined,
                                     const multi_session::SessionSet& kept, const mapping::SolvedMap& map) {
  std::vector<DriveSummary> drives;
  std::size_t place = 0;
  for (std::size_t d = 0; d < joined.verdicts.size(); ++d) {
    const multi_session::DriveVerdict& verdict = joined.verdicts[d];
    const multi_session::SessionRecord& record = verdict.belongs ? kept.drives[place++] : joined.set.drives[d];
    DriveSummary drive{record.name,  record.log,        verdict.belongs, verdict.belongs ? record.first_scan : 0,
                       record.scans, verdict.keyframes, verdict.in_map,  verdict.reason,
                       std::nullopt};
    if (verdict.belongs) {
      drive.absolute = error_of(record, map, input.truth[d]);
    }
    drives.push_back(std::move(drive));
  }
  return drives;
}

std::vector<InterSessionSummary> all_inter_session_loops(const multi_session::JoinedDrives& joined) {
  std::vector<InterSessionSummary> inter_session_loops;
  for (const multi_session::InterSessionLoop& j : joined.inter_session_loops) {
    inter_session_loops.push_back({joined.set.drives[j.first].name, joined.set.drives[j.second].name, j.candidates,
                                   j.accepted, j.checked, j.agree, j.best_p});
  }
  return inter_session_loops;
}

std::vector<std::string> warnings_of(const std::vector<DriveSummary>& drives) {
  std::vector<std::string> warnings;
  for (const DriveSummary& d : drives) {
    if (!d.belongs) {
      warnings.push_back("drive '" + d.name + "' (" + std::to_string(d.scans) +
                         " scans) does not belong and is left out: " + d.reason);
    }
  }
  return warnings;
}

std::string names_of(const std::vector<fs::path>& runs) {
  std::string text;
  for (const fs::path& run : runs) {
    text += (text.empty() ? "" : ", ") + fs::absolute(run).string();
  }
  return text;
}

}  // namespace

std::vector<DriveSummary> drive_summaries(const std::vector<multi_session::SessionRecord>& drives,
                                          const mapping::SolvedMap& map, const std::vector<Pose>& truth) {
  std::vector<DriveSummary> summaries;
  for (std::size_t d = 0; drives.size() > 1 && d < drives.size(); ++d) {
    DriveSummary drive{drives[d].name, drives[d].log, true, drives[d].first_scan, drives[d].scans, 0, 0, "", {}};
    for (const mapping::Keyframe& keyframe : map.keyframes) {
      if (keyframe.scan >= drive.first_scan && keyframe.scan < drive.first_scan + drive.scans) {
        ++drive.keyframes;
        drive.in_map += map.component[keyframe.scan] == 0 ? 1 : 0;
      }
    }
    drive.absolute = error_of(drives[d], map, poses_of(drives[d], truth));
    summaries.push_back(std::move(drive));
  }
  return summaries;
}

double driven_s(const std::vector<multi_session::SessionRecord>& drives,
                const std::vector<map_store::ScanRecord>& scans) {
  double sum = 0.0;
  for (const multi_session::SessionRecord& drive : drives) {
    sum += scans[drive.first_scan + drive.scans - 1].stamp_s - scans[drive.first_scan].stamp_s;
  }
  return sum;
}

MergeOutcome merge_runs(const MergeInput& input, const map_store::RunFolder& folder, const ProgramOptions& options,
                        bool one_frame, const std::vector<std::string>& arguments) {
  const Stopwatch whole;
  const std::string started = utc_now();
  for (std::size_t d = 0; one_frame && d < input.truth.size(); ++d) {
    if (input.truth[d].empty()) {
      throw InputError("drive '" + input.set.drives[d].name + "'", "", "has no true poses",
                       "merge without --one-frame");
    }
  }
  MergeOutcome outcome;
  MapTimes& times = outcome.map.times;
  multi_session::link_keyframes(input.set, folder);
  Stopwatch part;
  const multi_session::JoinedDrives joined = join(input.set, folder, options);
  times.loops = part.seconds();
  require_inter_session_loop(joined);
  const std::vector<bool> keep = belonging(joined);
  const multi_session::SessionSet set = multi_session::selected(joined.set, keep);
  multi_session::link_keyframes(set, folder);
  multi_session::write_records(set, folder);
  storage::write_file_atomically(folder / "config.yaml", options_as_yaml(options));
  const std::vector<Pose> truth = whole_truth(input, keep, one_frame);
  keep_truth(folder, set.scans, truth);

  part.reset();
  const mapping::SolvedMap map =
      mapping::solve_map(set.scans, set.loops, options.slam, options.pose_graph, set.decisions);
  times.solving = part.seconds();
  part.reset();
  write_maps(folder, set.scans, set.loops, map, options);
  times.products = part.seconds();
  MapSummary& summary = outcome.map.summary;
  summary = summarize(set.scans, set.loops, map, truth);
  summary.duration_s = driven_s(set.drives, set.scans);
  summary.compensation = "as in the run of each drive";
  summary.drives = all_drives(input, joined, set, map);
  summary.inter_session_loops = all_inter_session_loops(joined);
  outcome.warnings = warnings_of(summary.drives);
  times.whole = whole.seconds();
  write_map_report(folder, set.scans, set.loops, map, summary, times, truth, options.slam.min_loop_p);
  write_summary(folder, summary, times);
  map_export::write_manifest(folder, {arguments, names_of(input.runs), "", started, times.whole, 0});
  return outcome;
}

}  // namespace loopmark::workflows
