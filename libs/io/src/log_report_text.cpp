// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The reports of log_report.hpp in words and as JSON.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "loopmark/core/number_text.hpp"
#include "loopmark/io/log_report.hpp"

namespace loopmark::io {
namespace {

using Json = nlohmann::ordered_json;

std::string line(const char* what, const std::string& text) { return format_text("  %-13s", what) + text + "\n"; }

const char* name_of(PointTimeSource source) {
  switch (source) {
    case PointTimeSource::kInFiles:
      return "given";
    case PointTimeSource::kRebuilt:
      return "rebuilt";
    case PointTimeSource::kMixed:
      return "mixed";
    default:
      return "missing";
  }
}

std::string scans_text(const LogReport& r) {
  std::string text = std::to_string(r.scans);
  text += format_text(", %.1f s", r.stamps.duration_s);
  if (r.stamps.rate_hz > 0.0) {
    text += format_text(r.stamps.regular ? ", %.4g Hz" : ", irregular (median %.3g Hz: keyframes?)", r.stamps.rate_hz);
  }
  return text + ", times from " + r.info.stamps_source;
}

std::string points_text(const LogReport& r) {
  std::string text = format_text("%zu a scan (%zu to %zu)", r.points_median, r.points_least, r.points_most);
  text += r.has_intensity ? ", with intensity" : ", without intensity";
  text += r.has_ring ? ", with ring" : "";
  const std::size_t senseless = r.dropped.not_finite + r.dropped.absurd;
  if (senseless + r.dropped.no_return > 0) {
    text += format_text("; left out: %zu without echo, %zu not finite, %zu absurdly far", r.dropped.no_return,
                        r.dropped.not_finite, r.dropped.absurd);
  }
  return text;
}

/// The topic that is taken, and the others of the recording.
std::string topics_text(const LogReport& r) {
  if (!r.recording) {
    return "";
  }
  std::string text = line("topic", r.recording->topic + ", " + r.recording->topic_reason);
  text += line("", r.recording->topic_content);
  for (const TopicFacts& t : r.recording->topics) {
    const double duration = t.last_s - t.first_s;
    const double rate = duration > 0.0 ? static_cast<double>(t.messages - 1) / duration : 0.0;
    text += line("", format_text("%-28s %-28s %8zu messages, %.4g Hz, %.1f MB", t.topic.c_str(), t.type.c_str(), t.messages,
                            rate, 1e-6 * static_cast<double>(t.bytes)) +
                         (t.problem.empty() ? "" : ": " + t.problem));
  }
  return text;
}

Json topics_json(const LogReport& r) {
  Json topics = Json::array();
  for (const TopicFacts& t : r.recording->topics) {
    topics.push_back({{"topic", t.topic},
                      {"type", t.type},
                      {"messages", t.messages},
                      {"bytes", t.bytes},
                      {"first_s", t.first_s},
                      {"last_s", t.last_s},
                      {"scans", t.has_scans},
                      {"problem", t.problem}});
  }
  return topics;
}

std::string sensor_text(const SensorGuess& s) {
  std::string text = s.beams == 0 ? "beams cannot be told from the points"
                                  : format_text("%zu beams (from the %s)", s.beams, s.beams_from.c_str());
  text += format_text(", %.1f to %.1f deg, up to %.0f m", s.lowest_deg, s.highest_deg, s.farthest_m);
  return text + (s.name.empty() ? "" : ": like a " + s.name);
}

std::string times_text(const LogReport& r) {
  const std::string span = format_text("%.3f to %.3f s around the stamp", r.sweep_first_s, r.sweep_last_s);
  switch (r.point_times) {
    case PointTimeSource::kInFiles:
      return "given for every point, " + span;
    case PointTimeSource::kRebuilt:
      return std::string("rebuilt from the azimuth (") + (r.info.sweep->clockwise ? "clockwise" : "counter-clockwise") +
             "), " + span;
    case PointTimeSource::kMixed:
      return "given in some scans only";
    default:
      return "missing";
  }
}

std::string compensation_text(const LogReport& r) {
  std::string text = r.compensation.empty() ? "not measured" : r.compensation;
  if (r.info.motion_compensated) {
    text += *r.info.motion_compensated ? "; the log says that it is" : "; the log says that it is not";
  }
  return text;
}

/// "none", or the first few of the scans.
template <class Item, class Text>
std::string list_text(const std::vector<Item>& items, const Text& item_text) {
  constexpr std::size_t kMost = 5;
  std::string text = items.empty() ? "none" : std::to_string(items.size()) + ": ";
  for (std::size_t i = 0; i < items.size() && i < kMost; ++i) {
    text += (i == 0 ? "" : ", ") + item_text(items[i]);
  }
  return text + (items.size() > kMost ? ", ..." : "");
}

std::string irregularities_text(const LogReport& r) {
  const auto scan = [](std::size_t i) { return "scan " + std::to_string(i); };
  std::string text = line("gaps", list_text(r.stamps.gaps, [](const StampFacts::Gap& gap) {
                            return format_text("%.2f s before scan %zu", gap.seconds, gap.before);
                          }));
  if (!r.stamps.repeated.empty()) {
    text += line("same times", list_text(r.stamps.repeated, scan));
  }
  if (!r.stamps.backwards.empty()) {
    text += line("time goes back", list_text(r.stamps.backwards, scan));
  }
  if (!r.copies.empty()) {
    text += line("copies", list_text(r.copies, scan) + " (the very points of the scan before)");
  }
  text += line("damaged", list_text(r.damaged, [](const DamagedScanFact& fact) { return fact.problem; }));
  return text;
}

std::string truth_text(const LogReport& r) {
  if (r.info.truth_given) {
    return format_text("%s, a path of %.1f m", r.info.truth_source.c_str(), r.truth_length_m);
  }
  return r.info.truth_problem.empty() ? "none" : r.info.truth_problem;
}

template <class Item, class Convert>
Json list_json(const std::vector<Item>& items, const Convert& convert) {
  Json list = Json::array();
  for (const Item& item : items) {
    list.push_back(convert(item));
  }
  return list;
}

Json compensation_json(const LogReport& r) {
  Json json = {{"measured", r.compensation.empty() ? Json(nullptr) : Json(r.compensation)}};
  json["stated_by_log"] = r.info.motion_compensated ? Json(*r.info.motion_compensated) : Json(nullptr);
  return json;
}

}  // namespace

std::string next_command(const LogReport& report) {
  if (report.usable == 0 || !report.frame_problem.empty()) {
    return "";
  }
  const std::string rate = report.info.stamps_given ? "" : "  (state the rate of the scans with --set log.rate_hz=...)";
  return "loopmark map " + report.info.path.string() + " -o RUN" + rate;
}

std::string report_text(const LogReport& r) {
  std::string text = r.info.path.string() + "\n";
  text += line("format", r.info.format);
  text += topics_text(r);
  text += line("scans", scans_text(r));
  text += line("points", points_text(r));
  text += line("sensor", sensor_text(r.sensor));
  text += line("point times", times_text(r));
  text += line("compensated", compensation_text(r));
  text += r.viewpoints == 0
              ? ""
              : line("viewpoint",
                     format_text("%zu scans have a VIEWPOINT that moves the points; it is not applied", r.viewpoints));
  text += r.frame_problem.empty() ? "" : line("frame", r.frame_problem);
  text += irregularities_text(r);
  text += r.info.problem.empty() ? "" : line("problem", r.info.problem);
  text += line("truth", truth_text(r));
  const std::string next = next_command(r);
  return text + line("next", !next.empty()   ? next
                             : r.usable == 0 ? "no scan can be used"
                                             : "bring the scans into the sensor's frame: see frame");
}

std::string report_json(const LogReport& r) {
  Json json;
  json["path"] = r.info.path.string();
  json["format"] = r.info.format;
  if (r.recording) {
    json["topic"] = {{"name", r.recording->topic},
                     {"reason", r.recording->topic_reason},
                     {"content", r.recording->topic_content},
                     {"frame_id", r.recording->frame_id}};
    json["topics"] = topics_json(r);
  }
  json["scans"] = r.scans;
  json["usable"] = r.usable;
  json["points"] = {
      {"median", r.points_median},          {"least", r.points_least},   {"most", r.points_most},
      {"intensity", r.has_intensity},       {"ring", r.has_ring},        {"no_return", r.dropped.no_return},
      {"not_finite", r.dropped.not_finite}, {"absurd", r.dropped.absurd}};
  json["sensor"] = {
      {"beams", r.sensor.beams},           {"beams_from", r.sensor.beams_from},   {"name", r.sensor.name},
      {"lowest_deg", r.sensor.lowest_deg}, {"highest_deg", r.sensor.highest_deg}, {"farthest_m", r.sensor.farthest_m}};
  json["stamps"] = {{"given", r.info.stamps_given},      {"source", r.info.stamps_source},
                    {"duration_s", r.stamps.duration_s}, {"rate_hz", r.stamps.rate_hz},
                    {"regular", r.stamps.regular},       {"repeated", r.stamps.repeated},
                    {"backwards", r.stamps.backwards}};
  json["stamps"]["gaps"] = list_json(r.stamps.gaps, [](const StampFacts::Gap& gap) {
    return Json{{"before_scan", gap.before}, {"seconds", gap.seconds}};
  });
  json["point_times"] = {{"source", name_of(r.point_times)}, {"first_s", r.sweep_first_s}, {"last_s", r.sweep_last_s}};
  json["motion_compensated"] = compensation_json(r);
  json["copies"] = r.copies;
  json["damaged"] = list_json(r.damaged, [](const DamagedScanFact& fact) {
    return Json{{"scan", fact.index}, {"problem", fact.problem}};
  });
  json["truth"] = {{"given", r.info.truth_given},
                   {"source", r.info.truth_source},
                   {"problem", r.info.truth_problem},
                   {"length_m", r.truth_length_m}};
  json["problem"] = r.info.problem;
  json["viewpoints"] = r.viewpoints;
  json["frame_problem"] = r.frame_problem;
  json["next"] = next_command(r);
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string report_text(const DatasetReport& r) {
  std::string text = r.root.string() + "\n";
  text += line("layout", r.layout);
  text += line("conventions", r.description);
  std::size_t usable = 0, missing = 0;
  for (const SessionReport& session : r.sessions) {
    const std::string name = format_text("session %d", session.session.number);
    if (!session.session.present) {
      ++missing;
      text += line(name.c_str(), session.session.name + ": not there");
    } else if (!session.problem.empty()) {
      text += line(name.c_str(), session.session.name + ": " + session.problem);
    } else {
      ++usable;
      text +=
          line(name.c_str(), session.session.name +
                                 format_text(": %zu scans, frames %zu to %zu, %zu points in the first, ", session.scans,
                                             session.first_frame, session.last_frame, session.points) +
                                 (session.truth_given ? "with poses" : "without poses"));
    }
  }
  text += line("sum", format_text("%zu drives usable, %zu not there, %zu with problems", usable, missing,
                                  r.sessions.size() - usable - missing));
  return text + line("next", "loopmark evaluate SET --data " + r.root.string() + " -o RESULT");
}

std::string report_json(const DatasetReport& r) {
  Json json;
  json["root"] = r.root.string();
  json["layout"] = r.layout;
  json["conventions"] = r.description;
  json["sessions"] = list_json(r.sessions, [](const SessionReport& s) {
    return Json{{"session", s.session.number},  {"name", s.session.name},
                {"present", s.session.present}, {"scans", s.scans},
                {"first_frame", s.first_frame}, {"last_frame", s.last_frame},
                {"points_of_first", s.points},  {"truth", s.truth_given},
                {"problem", s.problem}};
  });
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace loopmark::io
