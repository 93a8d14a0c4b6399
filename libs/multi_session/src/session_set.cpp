// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/multi_session/session_set.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "loopmark/core/error.hpp"
#include "loopmark/map_store/record_rules.hpp"
#include "loopmark/map_store/run_records.hpp"

namespace loopmark::multi_session {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::size_t segments_in(const std::vector<map_store::ScanRecord>& scans) {
  std::size_t segments = 0;
  for (const map_store::ScanRecord& scan : scans) {
    segments = std::max(segments, scan.segment + 1);
  }
  return segments;
}

/// "day1", or "day1-2" where that is taken.
std::string free_name(const std::string& wanted, const std::vector<SessionRecord>& drives) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(drives.begin(), drives.end(), [&](const SessionRecord& d) { return d.name == name; });
  };
  std::string name = wanted;
  for (std::size_t i = 2; taken(name); ++i) {
    name = wanted + "-" + std::to_string(i);
  }
  return name;
}

/// Loops or decisions of kept keyframes, by their new numbers.
template <class Pair>
void renumber(const std::vector<Pair>& pairs, const std::vector<std::size_t>& number, std::vector<Pair>& into) {
  for (Pair pair : pairs) {
    pair.source = number[pair.source];
    pair.target = number[pair.target];
    if (pair.source != kNone && pair.target != kNone) {
      into.push_back(std::move(pair));
    }
  }
}

/// The scans of one drive behind those of `to`; `number` learns the keyframes' new numbers.
void take_scans(const SessionSet& set, const SessionRecord& drive, SessionSet& to, std::vector<std::size_t>& number) {
  const auto begin = set.scans.begin() + static_cast<std::ptrdiff_t>(drive.first_scan);
  const std::vector<map_store::ScanRecord> scans(begin, begin + static_cast<std::ptrdiff_t>(drive.scans));
  std::size_t first_segment = kNone;
  for (const map_store::ScanRecord& scan : scans) {
    first_segment = std::min(first_segment, scan.segment);
  }
  const std::size_t segments = segments_in(to.scans);
  for (map_store::ScanRecord scan : scans) {
    scan.scan = to.scans.size();
    scan.segment = scan.segment - first_segment + segments;
    if (scan.keyframe) {
      number[*scan.keyframe] = to.keyframe_files.size();
      to.keyframe_files.push_back(set.keyframe_files[*scan.keyframe]);
      scan.keyframe = number[*scan.keyframe];
    }
    to.scans.push_back(std::move(scan));
  }
}

void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::create_hard_link(from, to, error);
  if (error) {
    error.clear();
    std::filesystem::copy_file(from, to, error);
  }
  if (error) {
    throw InputError(from.string(), "", "cannot be taken over: " + error.message(), "map its log again");
  }
}

}  // namespace

std::vector<std::size_t> SessionSet::session_of_keyframe() const {
  std::vector<std::size_t> result;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    for (std::size_t i = drives[d].first_scan; i < drives[d].first_scan + drives[d].scans; ++i) {
      if (scans[i].keyframe) {
        result.push_back(d);
      }
    }
  }
  return result;
}

SessionSet read_session_set(const map_store::RunFolder& run) {
  map_store::RunRecords records = map_store::read_run_records(run);
  SessionSet set{read_sessions(run, records.scans),
                 std::move(records.scans),
                 std::move(records.loops),
                 std::move(records.decisions),
                 {}};
  const std::size_t count = map_store::keyframes_in(set.scans);
  if (count == 0) {
    throw InputError(run.scan_records().string(), "", "the run holds no keyframe");
  }
  for (std::size_t k = 0; k < count; ++k) {
    set.keyframe_files.push_back(run.keyframe(k, "pcd").replace_extension());
  }
  return set;
}

void append(SessionSet more, SessionSet& set) {
  for (const SessionRecord& drive : more.drives) {
    for (const SessionRecord& other : set.drives) {
      if (other.identity == drive.identity) {
        throw InputError("drive '" + drive.name + "' (" + drive.log + ")", "",
                         "is given twice: it is the same as '" + other.name + "'", "name each drive once");
      }
    }
  }
  std::vector<std::size_t> number(more.keyframe_files.size(), kNone);
  for (SessionRecord drive : more.drives) {
    const std::size_t first = set.scans.size();
    take_scans(more, drive, set, number);
    drive.name = free_name(drive.name, set.drives);
    drive.first_scan = first;
    set.drives.push_back(std::move(drive));
  }
  renumber(more.loops, number, set.loops);
  renumber(more.decisions, number, set.decisions);
}

SessionSet selected(const SessionSet& set, const std::vector<bool>& keep) {
  SessionSet result;
  std::vector<std::size_t> number(set.keyframe_files.size(), kNone);
  for (std::size_t d = 0; d < set.drives.size(); ++d) {
    if (keep[d]) {
      SessionRecord drive = set.drives[d];
      drive.first_scan = result.scans.size();
      take_scans(set, set.drives[d], result, number);
      result.drives.push_back(std::move(drive));
    }
  }
  renumber(set.loops, number, result.loops);
  renumber(set.decisions, number, result.decisions);
  return result;
}

void link_keyframes(const SessionSet& set, const map_store::RunFolder& run) {
  std::filesystem::remove_all(run / "keyframes");
  std::filesystem::create_directories(run / "keyframes");
  for (std::size_t k = 0; k < set.keyframe_files.size(); ++k) {
    for (const char* ending : {"pcd", "place", "prepared"}) {
      link_or_copy(set.keyframe_files[k].string() + "." + ending, run.keyframe(k, ending));
    }
  }
}

}  // namespace loopmark::multi_session
