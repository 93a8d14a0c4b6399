// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "drill_page.hpp"
#include "loopmark/report/table.hpp"
#include "loopmark/statistics/statistics.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/text_table.hpp"
#include "map_report.hpp"

namespace loopmark::workflows {
namespace {

using report::Cell;
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

  void add(const kidnap_benchmark::DrillOutcome& outcome, const kidnap_benchmark::DrillOptions& options) {
    ++events;
    const bool good = kidnap_benchmark::succeeded(outcome, options);
    in_time += good ? 1 : 0;
    late += !good && outcome.verdict == kidnap_benchmark::DrillVerdict::kRecovered ? 1 : 0;
    wrong += outcome.verdict == kidnap_benchmark::DrillVerdict::kWrong ? 1 : 0;
    none += outcome.verdict == kidnap_benchmark::DrillVerdict::kNone ? 1 : 0;
    if (outcome.verdict == kidnap_benchmark::DrillVerdict::kRecovered) {
      seconds.push_back(outcome.seconds);
    }
  }
};

Tally tally(const DrillResult& r, const std::string& name,
            const std::function<bool(const kidnap_benchmark::DrillEvent&)>& counts) {
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
  std::vector<Tally> all = {tally(r, "all", [](const kidnap_benchmark::DrillEvent&) { return true; })};
  for (const kidnap_benchmark::Stratum stratum : kidnap_benchmark::kStrata) {
    all.push_back(tally(r, name(stratum), [&](const kidnap_benchmark::DrillEvent& e) { return e.stratum == stratum; }));
  }
  for (const kidnap_benchmark::Disturbance disturbance :
       {kidnap_benchmark::Disturbance::kOutage, kidnap_benchmark::Disturbance::kTeleport,
        kidnap_benchmark::Disturbance::kTurned, kidnap_benchmark::Disturbance::kOtherDrive}) {
    all.push_back(tally(r, name(disturbance),
                        [&](const kidnap_benchmark::DrillEvent& e) { return e.disturbance == disturbance; }));
  }
  return all;
}

std::string interval_text(std::size_t part, std::size_t whole) {
  if (whole == 0) {
    return "-";
  }
  const statistics::Interval interval = statistics::wilson_interval(part, whole);
  const double share = static_cast<double>(part) / static_cast<double>(whole);
  return text::percent(share, 1) + " (" + text::fixed(100.0 * interval.low, 1) + " - " +
         text::fixed(100.0 * interval.high, 1) + ")";
}

report::Table table_of(const DrillResult& r) {
  report::Table table({"events at / by", "events",
                       "right within " + text::fixed(r.options.within_s, 1) + " s, % (95 %)", "later", "no pose",
                       "wrong", "wrong, % (95 %)", "median s", "longest s"});
  for (const Tally& t : tallies(r)) {
    table.row({t.name, report::count_cell(t.events), interval_text(t.in_time, t.events), report::count_cell(t.late),
               report::count_cell(t.none), report::count_cell(t.wrong), interval_text(t.wrong, t.events),
               report::number_cell(statistics::quantile(t.seconds, 0.5), 1),
               report::number_cell(statistics::quantile(t.seconds, 1.0), 1)});
  }
  return table;
}

const kidnap_benchmark::DrillScan& arrival(const DrillResult& r, const kidnap_benchmark::DrillEvent& event) {
  return (event.disturbance == kidnap_benchmark::Disturbance::kOtherDrive ? r.drive_scans : r.scans)[event.after];
}

report::Table events_table(const DrillResult& r) {
  report::Table table({"event",       "disturbance", "stratum",  "last scan", "first scan", "gap_s",   "yaw_deg",
                       "verdict",     "seconds",     "driven_m", "noticed",   "p_correct",  "error_m", "error_deg",
                       "placed scan", "x",           "y",        "truth_x",   "truth_y",    "reason"});
  for (std::size_t i = 0; i < r.events.size(); ++i) {
    const kidnap_benchmark::DrillEvent& e = r.events[i];
    const kidnap_benchmark::DrillOutcome& o = r.outcomes[i];
    const bool placed = o.verdict != kidnap_benchmark::DrillVerdict::kNone;
    const auto number = [&](double value, int decimals) {
      return placed ? report::number_cell(value, decimals) : report::Cell("");
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
               placed ? report::count_cell(o.scan) : report::Cell(""),
               number(at.x(), 2),
               number(at.y(), 2),
               report::number_cell(truth.x(), 2),
               report::number_cell(truth.y(), 2),
               o.reason});
  }
  return table;
}

std::string method(const DrillResult& r) {
  return "Each event follows the drive for " + text::fixed(r.options.before_s, 1) +
         " s from its known pose, cuts it, and goes on: after an outage, in another part of the log, with the sensor "
         "turned, or in another drive. A pose is right nearer than " +
         text::fixed(r.options.right_m, 2) + " m and turned by less than " + text::fixed(r.options.right_deg, 1) +
         " deg against the map's own trajectory; the first pose given must be right and every one for " +
         text::fixed(r.options.settle_s, 1) +
         " s behind it, else the event is wrong. An event ends without a pose after " +
         text::fixed(r.options.limit_s, 0) + " s of driving. " +
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
    const statistics::Interval success = statistics::wilson_interval(t.in_time, t.events);
    const statistics::Interval wrong = statistics::wilson_interval(t.wrong, t.events);
    nlohmann::ordered_json of = {
        {"events", t.events}, {"in_time", t.in_time}, {"late", t.late}, {"none", t.none}, {"wrong", t.wrong}};
    of["in_time_interval"] = {success.low, success.high};
    of["wrong_interval"] = {wrong.low, wrong.high};
    of["median_s"] =
        t.seconds.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(statistics::quantile(t.seconds, 0.5));
    json["by"][t.name] = of;
  }
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace

void write_drill(const std::filesystem::path& folder, const std::filesystem::path& run, const DrillResult& r) {
  storage::write_file_atomically(folder / "drill.csv", events_table(r).csv());
  storage::write_file_atomically(folder / "summary.json", summary_json(r));
  const Tally all = tallies(r).front();
  internal::write_drill_page(
      folder, run, r,
      {{"events", std::to_string(all.events)},
       {"right within " + text::fixed(r.options.within_s, 1) + " s", interval_text(all.in_time, all.events)},
       {"wrong", std::to_string(all.wrong)},
       {"no pose", std::to_string(all.none)},
       {"seed", std::to_string(r.options.seed)}},
      method(r), {internal::page_table("Where tracking was cut", table_of(r))});
}

std::string drill_table(const DrillResult& r) { return table_of(r).text(); }

}  // namespace loopmark::workflows
