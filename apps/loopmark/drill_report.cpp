// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "drill_run.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/evaluation/statistics.hpp"
#include "loopmark/evaluation/text_table.hpp"
#include "loopmark/report/page.hpp"

namespace loopmark::app {
namespace {

using report::Cell;
using report::Page;
using report::Plot;
using report::Table;

/// The events of one kind, counted.
struct Tally {
  std::string name;
  std::size_t events = 0;
  std::size_t in_time = 0;
  std::size_t late = 0;
  std::size_t wrong = 0;
  std::size_t none = 0;
  std::vector<double> seconds;  ///< of the right ones

  void add(const DrillOutcome& outcome, const DrillOptions& options) {
    ++events;
    const bool good = succeeded(outcome, options);
    in_time += good ? 1 : 0;
    late += !good && outcome.verdict == DrillVerdict::kRecovered ? 1 : 0;
    wrong += outcome.verdict == DrillVerdict::kWrong ? 1 : 0;
    none += outcome.verdict == DrillVerdict::kNone ? 1 : 0;
    if (outcome.verdict == DrillVerdict::kRecovered) {
      seconds.push_back(outcome.seconds);
    }
  }
};

Tally tally(const DrillResult& r, const std::string& name, const std::function<bool(const DrillEvent&)>& counts) {
  Tally result;
  result.name = name;
  for (std::size_t i = 0; i < r.events.size(); ++i) {
    if (counts(r.events[i])) {
      result.add(r.outcomes[i], r.options);
    }
  }
  return result;
}

/// All, then by stratum, then by disturbance.
std::vector<Tally> tallies(const DrillResult& r) {
  std::vector<Tally> all = {tally(r, "all", [](const DrillEvent&) { return true; })};
  for (const Stratum stratum : kStrata) {
    all.push_back(tally(r, name(stratum), [&](const DrillEvent& e) { return e.stratum == stratum; }));
  }
  for (const Disturbance disturbance :
       {Disturbance::kOutage, Disturbance::kTeleport, Disturbance::kTurned, Disturbance::kOtherDrive}) {
    all.push_back(tally(r, name(disturbance), [&](const DrillEvent& e) { return e.disturbance == disturbance; }));
  }
  return all;
}

std::string interval_text(std::size_t part, std::size_t whole) {
  if (whole == 0) {
    return "-";
  }
  const Interval interval = wilson_interval(part, whole);
  const double share = static_cast<double>(part) / static_cast<double>(whole);
  return percent(share, 1) + " (" + fixed(100.0 * interval.low, 1) + " - " + fixed(100.0 * interval.high, 1) + ")";
}

Table table_of(const DrillResult& r) {
  Table table({"events at / by", "events", "right within " + fixed(r.options.within_s, 1) + " s, % (95 %)", "later",
               "no pose", "wrong", "wrong, % (95 %)", "median s", "longest s"});
  for (const Tally& t : tallies(r)) {
    table.row({t.name, report::count_cell(t.events), interval_text(t.in_time, t.events), report::count_cell(t.late),
               report::count_cell(t.none), report::count_cell(t.wrong), interval_text(t.wrong, t.events),
               report::number_cell(quantile(t.seconds, 0.5), 1), report::number_cell(quantile(t.seconds, 1.0), 1)});
  }
  return table;
}

const DrillScan& arrival(const DrillResult& r, const DrillEvent& event) {
  return (event.disturbance == Disturbance::kOtherDrive ? r.drive_scans : r.scans)[event.after];
}

Table events_table(const DrillResult& r, const std::function<bool(const DrillOutcome&)>& shown) {
  Table table({"event",       "disturbance", "stratum",  "last scan", "first scan", "gap_s",   "yaw_deg",
               "verdict",     "seconds",     "driven_m", "noticed",   "p_correct",  "error_m", "error_deg",
               "placed scan", "x",           "y",        "truth_x",   "truth_y",    "reason"});
  for (std::size_t i = 0; i < r.events.size(); ++i) {
    const DrillEvent& e = r.events[i];
    const DrillOutcome& o = r.outcomes[i];
    if (!shown(o)) {
      continue;
    }
    const bool placed = o.verdict != DrillVerdict::kNone;
    const auto number = [&](double value, int decimals) {
      return placed ? report::number_cell(value, decimals) : Cell("");
    };
    const Eigen::Vector3d at = o.T_map_answer.translation();
    const Eigen::Vector3d truth = placed ? o.T_map_truth.translation() : arrival(r, e).T_map_lidar.translation();
    table.row({report::count_cell(e.number),
               name(e.disturbance),
               name(e.stratum),
               report::count_cell(r.scans[e.before].scan),
               report::count_cell(arrival(r, e).scan),
               report::number_cell(e.outage_s, 2),
               report::number_cell(e.yaw_deg, 1),
               name(o.verdict),
               report::number_cell(o.seconds, 2),
               report::number_cell(o.driven_m, 2),
               o.noticed ? "yes" : "no",
               number(o.p_correct, 4),
               number(o.error.translation_m, 3),
               number(o.error.rotation_deg, 2),
               placed ? report::count_cell(o.scan) : Cell(""),
               number(at.x(), 2),
               number(at.y(), 2),
               report::number_cell(truth.x(), 2),
               report::number_cell(truth.y(), 2),
               o.reason});
  }
  return table;
}

Plot map_plot(const DrillResult& r) {
  Plot plot("Where tracking was cut", "x [m]", "y [m]");
  plot.equal_axes();
  std::vector<double> x, y;
  for (const Pose& pose : r.T_map_scan) {
    x.push_back(pose.translation().x());
    y.push_back(pose.translation().y());
  }
  plot.line("map", x, y, {.colour = report::kGrey});
  const auto points = [&](const std::string& label, std::size_t colour, const auto& shown) {
    std::vector<double> px, py;
    for (std::size_t i = 0; i < r.events.size(); ++i) {
      if (shown(r.outcomes[i])) {
        px.push_back(arrival(r, r.events[i]).T_map_lidar.translation().x());
        py.push_back(arrival(r, r.events[i]).T_map_lidar.translation().y());
      }
    }
    plot.points(label, px, py, {.colour = report::palette(colour), .radius = 4.0});
  };
  points("right in time", 2, [&](const DrillOutcome& o) { return succeeded(o, r.options); });
  points("right later", 0,
         [&](const DrillOutcome& o) { return o.verdict == DrillVerdict::kRecovered && !succeeded(o, r.options); });
  points("no pose", 1, [](const DrillOutcome& o) { return o.verdict == DrillVerdict::kNone; });
  points("wrong", 5, [](const DrillOutcome& o) { return o.verdict == DrillVerdict::kWrong; });
  for (const DrillOutcome& o : r.outcomes) {
    if (o.verdict == DrillVerdict::kWrong) {
      plot.line("", {o.T_map_truth.translation().x(), o.T_map_answer.translation().x()},
                {o.T_map_truth.translation().y(), o.T_map_answer.translation().y()},
                {.colour = report::palette(5), .dashed = true});
    }
  }
  return plot;
}

Plot time_plot(const DrillResult& r) {
  std::vector<double> seconds;
  for (const DrillOutcome& o : r.outcomes) {
    seconds.push_back(o.verdict == DrillVerdict::kRecovered ? o.seconds : std::numeric_limits<double>::quiet_NaN());
  }
  const report::Histogram histogram = report::histogram(seconds, 0.0, r.options.limit_s, 30);
  Plot plot("Time to a right pose", "seconds of driving", "events");
  plot.bars("", histogram.edges, histogram.counts);
  return plot;
}

std::string method(const DrillResult& r) {
  return "Each event follows the drive for " + fixed(r.options.before_s, 1) +
         " s from its known pose, cuts it, and goes on: after an outage, in another part of the log, with the sensor "
         "turned, or in another drive. A pose is right nearer than " +
         fixed(r.options.right_m, 2) + " m and turned by less than " + fixed(r.options.right_deg, 1) +
         " deg against the map's own trajectory; the first pose given must be right and every one for " +
         fixed(r.options.settle_s, 1) + " s behind it, else the event is wrong. An event ends without a pose after " +
         fixed(r.options.limit_s, 0) + " s of driving. " +
         (r.left_out > 0 ? "Every other keyframe was kept out of the map, and only those and scans that are no "
                           "keyframes were fed."
                         : "Only scans that are no keyframes of the map were fed.") +
         " Strata, from the map itself: near-identical: another place looks more alike than the same place a few "
         "metres on; open: less than 40 % of the median structure; junction: the path turns by over 30 deg within 24 m "
         "or is crossed; straight: all else. Intervals: Wilson, 95 %.";
}

std::string summary_json(const DrillResult& r) {
  nlohmann::ordered_json json = {{"format", "loopmark drill 1"},   {"events", r.events.size()},
                                 {"planned", r.options.events},    {"seed", r.options.seed},
                                 {"within_s", r.options.within_s}, {"limit_s", r.options.limit_s},
                                 {"keyframes", r.keyframes},       {"left_out", r.left_out},
                                 {"fed_scans", r.scans.size()},    {"drive_scans", r.drive_scans.size()}};
  for (const Tally& t : tallies(r)) {
    const Interval success = wilson_interval(t.in_time, t.events);
    const Interval wrong = wilson_interval(t.wrong, t.events);
    nlohmann::ordered_json of = {
        {"events", t.events}, {"in_time", t.in_time}, {"late", t.late}, {"none", t.none}, {"wrong", t.wrong}};
    of["in_time_interval"] = {success.low, success.high};
    of["wrong_interval"] = {wrong.low, wrong.high};
    of["median_s"] = t.seconds.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(quantile(t.seconds, 0.5));
    json["by"][t.name] = of;
  }
  return json.dump(1) + "\n";
}

}  // namespace

void write_drill(const std::filesystem::path& folder, const DrillResult& r) {
  const auto every = [](const DrillOutcome&) { return true; };
  const auto wrong = [](const DrillOutcome& o) { return o.verdict == DrillVerdict::kWrong; };
  write_file_atomically(folder / "drill.csv", events_table(r, every).csv());
  write_file_atomically(folder / "summary.json", summary_json(r));
  const Tally all = tallies(r).front();
  Page page("Kidnap drill", r.run + (r.drive.empty() ? "" : ", and the drive " + r.drive));
  page.facts({{"events", std::to_string(all.events)},
              {"right within " + fixed(r.options.within_s, 1) + " s", interval_text(all.in_time, all.events)},
              {"wrong", std::to_string(all.wrong)},
              {"no pose", std::to_string(all.none)},
              {"seed", std::to_string(r.options.seed)}});
  page.heading("Results").table(table_of(r)).paragraph(method(r));
  page.heading("Places").plot(map_plot(r));
  page.heading("Time").plot(time_plot(r));
  page.heading("Wrong poses").table(events_table(r, wrong));
  page.heading("All events").details("every event", Page("").table(events_table(r, every)));
  write_file_atomically(folder / "report.html", page.html());
}

std::string drill_table(const DrillResult& r) { return table_of(r).text(); }

}  // namespace loopmark::app
