// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_page/answers.hpp"

#include <algorithm>
#include <cstdio>

namespace loopmark::map_page {
namespace {

std::string share_text(std::size_t part, std::size_t whole) {
  char text[64];
  std::snprintf(text, sizeof text, "%zu of %zu (%.1f %%)", part, whole,
                whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0);
  return text;
}

FindingLink link_to(const AnswerLayer& layer, std::size_t i) {
  return {layer.answers[i].name, LinkKind::kAnswer, i, i};
}

/// Wrong answers, those that were believed most first.
void add_wrong(const AnswerLayer& layer, std::vector<Finding>& all) {
  std::vector<std::size_t> wrong;
  std::size_t judged = 0;
  for (std::size_t i = 0; i < layer.answers.size(); ++i) {
    judged += layer.answers[i].placed && layer.answers[i].truth.allFinite() ? 1 : 0;
    if (layer.answers[i].wrong) {
      wrong.push_back(i);
    }
  }
  std::stable_sort(wrong.begin(), wrong.end(), [&](std::size_t a, std::size_t b) {
    return layer.answers[a].p_correct > layer.answers[b].p_correct;
  });
  if (judged == 0) {
    all.push_back({Severity::kLook, "The truth is not known: nothing says whether the answers are right.", {}});
  } else if (wrong.empty()) {
    all.push_back({Severity::kGood, "All " + std::to_string(judged) + " answers that could be judged are right.", {}});
  } else {
    Finding finding{Severity::kProblem, share_text(wrong.size(), judged) + " answers are wrong; the surest first:", {}};
    for (const std::size_t i : wrong) {
      finding.links.push_back(link_to(layer, i));
    }
    all.push_back(finding);
  }
}

/// Stretches without a position, the longest first.
void add_unplaced(const AnswerLayer& layer, std::vector<Finding>& all) {
  struct Stretch {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  std::vector<Stretch> stretches;
  std::size_t sum = 0;
  for (std::size_t i = 0; i < layer.answers.size(); ++i) {
    if (layer.answers[i].placed) {
      continue;
    }
    ++sum;
    if (!stretches.empty() && stretches.back().first + stretches.back().count == i) {
      ++stretches.back().count;
    } else {
      stretches.push_back({i, 1});
    }
  }
  if (sum == 0) {
    return;
  }
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const Stretch& a, const Stretch& b) { return a.count > b.count; });
  Finding finding{
      Severity::kLook, share_text(sum, layer.answers.size()) + " got no position; the longest in a row:", {}};
  for (const Stretch& stretch : stretches) {
    FindingLink link = link_to(layer, stretch.first);
    link.text += " (" + std::to_string(stretch.count) + ")";
    finding.links.push_back(link);
  }
  all.push_back(finding);
}

}  // namespace

std::vector<Finding> findings(const AnswerLayer& layer) {
  std::vector<Finding> all;
  add_wrong(layer, all);
  add_unplaced(layer, all);
  std::stable_sort(all.begin(), all.end(), [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
  return all;
}

}  // namespace loopmark::map_page
