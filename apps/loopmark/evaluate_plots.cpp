// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_plots.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark::app {

using report::Plot;
using report::Style;

namespace {

/// The middle of a bin, for the axis; the last bin is open.
double middle_of(const evaluation::RecallBin& bin) {
  return 0.5 * (bin.low + std::min(bin.high, 2.0 * bin.low + 10.0));
}

/// How far apart along x the intervals of neighbouring algorithms stand, so that none hides another.
double step_beside(const std::vector<evaluation::RecallBin>& bins) {
  constexpr double kShareOfAxis = 0.012;
  return bins.empty() ? 0.0 : kShareOfAxis * (middle_of(bins.back()) - middle_of(bins.front()));
}

}  // namespace

report::Plot recall_plot(const std::vector<evaluation::AlgorithmSummary>& summaries, const std::string& title,
                         const std::string& quantity,
                         std::vector<evaluation::RecallBin> evaluation::AlgorithmSummary::*bins) {
  report::Plot plot(title, quantity, "recall [%]");
  plot.y_range(-3.0, 103.0).size(520, 340);
  for (std::size_t a = 0; a < summaries.size(); ++a) {
    const double beside = step_beside(summaries[a].*bins) *
                          (static_cast<double>(a) - 0.5 * (static_cast<double>(summaries.size()) - 1.0));
    std::vector<double> x, y, low, high;
    for (const evaluation::RecallBin& bin : summaries[a].*bins) {
      if (bin.pairs > 0) {
        const statistics::Interval interval = statistics::wilson_interval(bin.successes, bin.pairs);
        x.push_back(middle_of(bin) + beside);
        y.push_back(100.0 * bin.recall());
        low.push_back(100.0 * interval.low);
        high.push_back(100.0 * interval.high);
      }
    }
    report::Style style;
    style.colour = report::palette(a);
    plot.line(summaries[a].name, x, y, style).points("", x, y, style).intervals("", x, low, high, style);
  }
  return plot;
}

report::Plot error_plot(const evaluation::StoredResult& result,
                        const std::vector<evaluation::AlgorithmSummary>& summaries, bool rotation) {
  report::Plot plot(rotation ? "Rotation error" : "Translation error", rotation ? "RE below [deg]" : "TE below [m]",
                    "pairs [%]");
  plot.y_range(0.0, 100.0).x_range(0.0, rotation ? 10.0 : 2.0).size(520, 340);
  for (const evaluation::AlgorithmSummary& summary : summaries) {
    const std::string& name = summary.name;
    std::vector<double> errors;
    for (const evaluation::Outcome& outcome : result.outcomes) {
      if (outcome.algorithm == name && !outcome.negative) {
        errors.push_back(rotation ? outcome.error.rotation_deg : outcome.error.translation_m);
      }
    }
    std::sort(errors.begin(), errors.end());
    std::vector<double> x, y;
    const std::size_t step = std::max<std::size_t>(1, errors.size() / 400);
    for (std::size_t i = 0; i < errors.size() && errors[i] <= (rotation ? 10.0 : 2.0); i += step) {
      x.push_back(errors[i]);
      y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(errors.size()));
    }
    plot.line(name, x, y);
  }
  return plot;
}

report::Plot time_plot(const std::vector<evaluation::AlgorithmSummary>& summaries) {
  report::Plot plot("Recall against time", "median seconds a pair, the paper's accounting", "recall [%]");
  plot.log_x().size(520, 340);
  for (std::size_t a = 0; a < summaries.size(); ++a) {
    const double seconds = summaries[a].paper_seconds.median;
    if (std::isnan(seconds) || seconds <= 0.0) {
      continue;
    }
    report::Style style;
    style.colour = report::palette(a);
    style.radius = 5.0;
    plot.points(summaries[a].name, {seconds}, {100.0 * summaries[a].recall()}, style);
    plot.intervals("", {seconds}, {100.0 * summaries[a].recall_interval.low},
                   {100.0 * summaries[a].recall_interval.high}, style);
  }
  return plot;
}

report::Plot precision_recall_plot(const std::vector<evaluation::AlgorithmSummary>& summaries) {
  report::Plot plot("Precision and recall of the answers", "recall [%]", "precision [%]");
  plot.x_range(0.0, 100.0).y_range(0.0, 103.0).size(520, 340);
  for (const evaluation::AlgorithmSummary& summary : summaries) {
    std::vector<double> x, y;
    for (const statistics::PrecisionRecallPoint& point : summary.precision_recall) {
      x.push_back(100.0 * point.recall);
      y.push_back(100.0 * point.precision);
    }
    if (!x.empty()) {
      plot.line(summary.name, x, y);
    }
  }
  return plot;
}

report::Plot reliability_plot(const std::vector<evaluation::AlgorithmSummary>& summaries) {
  report::Plot plot("Reliability", "stated probability", "share right");
  report::Style honest;
  honest.colour = report::kGrey;
  honest.dashed = true;
  plot.x_range(0.0, 1.0).y_range(0.0, 1.0).size(520, 340).line("honest", {0.0, 1.0}, {0.0, 1.0}, honest);
  for (std::size_t a = 0; a < summaries.size(); ++a) {
    std::vector<double> x, y;
    for (const statistics::ReliabilityBin& bin : summaries[a].reliability) {
      if (bin.count > 0) {
        x.push_back(bin.mean_p);
        y.push_back(bin.share_correct);
      }
    }
    if (!x.empty()) {
      report::Style style;
      style.colour = report::palette(a);
      style.radius = 4.0;
      plot.line(summaries[a].name, x, y, style).points("", x, y, style);
    }
  }
  return plot;
}

}  // namespace loopmark::app
