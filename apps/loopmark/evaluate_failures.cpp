// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_failures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark::app {
namespace {

/// What failed, by pair: the outcomes in the order of the algorithms.
using FailuresOfPairs = std::map<std::size_t, std::vector<const evaluation::Outcome*>>;

bool has_failed(const evaluation::Outcome& outcome) {
  return outcome.negative ? outcome.answer.status == evaluation::AnswerStatus::kAnswered : !outcome.success;
}

std::vector<const evaluation::Outcome*> failures_of(const evaluation::StoredResult& result,
                                                    const std::string& algorithm) {
  std::vector<const evaluation::Outcome*> failures;
  for (const evaluation::Outcome& outcome : result.outcomes) {
    if (outcome.algorithm == algorithm && has_failed(outcome)) {
      failures.push_back(&outcome);
    }
  }
  return failures;
}

report::Table failure_list(const evaluation::StoredResult& result,
                           const std::vector<const evaluation::Outcome*>& failures) {
  report::Table table(
      {"Pair", "Frames", "Status", "TE (m)", "RE (deg)", "P(correct)", "Distance (m)", "Overlap", "Note"},
      "Failed pairs");
  for (const evaluation::Outcome* outcome : failures) {
    const bool negative = outcome->negative;
    const pair_sets::RegistrationPair* pair = negative ? nullptr : &result.set.pairs[outcome->pair];
    table.row({report::count_cell(outcome->pair), to_string(result.set.key(outcome->pair)),
               negative ? "false accept" : to_string(outcome->answer.status),
               report::number_cell(outcome->error.translation_m, 2),
               report::number_cell(outcome->error.rotation_deg, 2), report::number_cell(outcome->answer.p_correct, 3),
               pair == nullptr ? report::Cell("-") : report::number_cell(pair->motion.head<3>().norm(), 1),
               pair == nullptr ? report::Cell("-") : report::number_cell(pair->overlap_symmetric, 2),
               outcome->answer.note});
  }
  return table;
}

/// Up to three answers that differ by more than a metre or five degrees, under the algorithm that gave each first.
std::vector<report::MotionPanel> answers_of(const std::vector<const evaluation::Outcome*>& failures) {
  constexpr std::size_t kMost = 3;
  constexpr double kAlikeM = 1.0;
  constexpr double kAlikeDeg = 5.0;
  std::vector<report::MotionPanel> panels;
  for (const evaluation::Outcome* outcome : failures) {
    const bool known = std::any_of(panels.begin(), panels.end(), [&](const report::MotionPanel& panel) {
      const PoseError apart = pose_error(outcome->answer.T_target_source, panel.T_target_source);
      return apart.translation_m < kAlikeM && apart.rotation_deg < kAlikeDeg;
    });
    if (!known && outcome->answer.has_motion() && panels.size() < kMost) {
      panels.push_back({outcome->algorithm, outcome->answer.T_target_source});
    }
  }
  return panels;
}

/// Loads and draws one failed pair.
report::Image picture_of(std::size_t index, const std::vector<const evaluation::Outcome*>& failures,
                         const evaluation::StoredResult& result, const evaluation::ScanLoader& load,
                         const std::vector<Pose>& perturbations) {
  constexpr double kVoxelM = 0.4;
  constexpr std::size_t kPanelWidth = 320;
  const pair_sets::PairKey& key = result.set.key(index);
  PointCloud source = load(key.session, key.source);
  if (index < perturbations.size()) {
    source = transformed(source, perturbations[index]);
  }
  std::vector<report::MotionPanel> panels = answers_of(failures);
  if (index < result.set.pairs.size()) {
    panels.push_back({"true", result.set.pairs[index].T_target_source});
  }
  return report::motions_picture(cloud::voxel_downsampled(source, kVoxelM).points,
                                 cloud::voxel_downsampled(load(key.target_session, key.target), kVoxelM).points, panels,
                                 kPanelWidth * std::max<std::size_t>(2, panels.size()));
}

std::string errors_of(const evaluation::Outcome& outcome) {
  if (!outcome.answer.has_motion()) {
    return outcome.algorithm + ": " + to_string(outcome.answer.status);
  }
  std::string all = outcome.algorithm;
  all += outcome.negative
             ? ": answered"
             : format_text(": TE %.2f m, RE %.1f deg", outcome.error.translation_m, outcome.error.rotation_deg);
  if (std::isfinite(outcome.answer.p_correct)) {
    all += format_text(", P %.2f", outcome.answer.p_correct);
  }
  return all;
}

std::string caption_of(std::size_t index, const std::vector<const evaluation::Outcome*>& failures,
                       const evaluation::StoredResult& result) {
  std::string text = "Pair " + std::to_string(index) + " (" + to_string(result.set.key(index)) + ")";
  if (index < result.set.pairs.size()) {
    const pair_sets::RegistrationPair& pair = result.set.pairs[index];
    text += format_text(", %.1f m apart, overlap %.2f", pair.motion.head<3>().norm(), pair.overlap_symmetric);
  } else {
    text += ", two different places";
  }
  constexpr std::size_t kNamed = 12;
  for (std::size_t i = 0; i < std::min(kNamed, failures.size()); ++i) {
    text += (i == 0 ? ". " : "; ") + errors_of(*failures[i]);
  }
  return text + (failures.size() > kNamed ? "; and " + std::to_string(failures.size() - kNamed) + " more." : ".");
}

/// A picture for each, drawn a few at a time: the memory does not grow with their number.
void add_pictures(report::Page& page, const FailuresOfPairs& failed, const evaluation::StoredResult& result,
                  const evaluation::ScanLoader& load, const std::vector<Pose>& perturbations, std::size_t pictures) {
  constexpr std::size_t kAtOnce = 16;
  std::vector<FailuresOfPairs::const_iterator> batch;
  std::vector<report::Image> images;
  std::size_t drawn = 0;
  for (auto next = failed.begin(); next != failed.end() && drawn < pictures; drawn += batch.size()) {
    batch.clear();
    while (next != failed.end() && batch.size() < std::min(kAtOnce, pictures - drawn)) {
      batch.push_back(next++);
    }
    images.assign(batch.size(), {});
    parallel_for(batch.size(), [&](std::size_t i) {
      images[i] = picture_of(batch[i]->first, batch[i]->second, result, load, perturbations);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      page.picture(images[i], caption_of(batch[i]->first, batch[i]->second, result));
    }
  }
}

}  // namespace

void add_failures(report::Page& page, const evaluation::StoredResult& result, const evaluation::ScanLoader& load,
                  const std::vector<Pose>& perturbations, std::size_t pictures) {
  page.heading("Failures");
  FailuresOfPairs failed;
  for (const std::string& algorithm : result.experiment.algorithms) {
    const std::vector<const evaluation::Outcome*> failures = failures_of(result, algorithm);
    for (const evaluation::Outcome* outcome : failures) {
      failed[outcome->pair].push_back(outcome);
    }
    if (!failures.empty()) {
      page.details(algorithm + ": " + std::to_string(failures.size()) + " failed pairs",
                   report::Page("").table(failure_list(result, failures)));
    }
  }
  if (failed.empty()) {
    page.paragraph("No pair failed.");
    return;
  }
  report::Page gallery("");
  if (load) {
    add_pictures(gallery, failed, result, load, perturbations, pictures);
  }
  if (!load) {
    gallery.paragraph("No scans were given (--data), so nothing is drawn.");
  } else if (pictures < failed.size()) {
    gallery.paragraph("The first " + std::to_string(pictures) + " of " + std::to_string(failed.size()) +
                      " pairs are drawn (--pictures N draws more).");
  }
  page.details(
      "Pictures of the " + std::to_string(failed.size()) + " pairs that failed: what was answered, what is true",
      gallery);
}

}  // namespace loopmark::app
