// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "layout_parts.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>

#include "loopmark/core/number_text.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io::internal {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kLargestFrame = 100'000'000;
constexpr double kUsualStep_s = 0.1;  // where no two times rise

bool by_name(const fs::path& a, const fs::path& b) {
  return text::natural_less(a.filename().string(), b.filename().string());
}

/// The name without its known endings: "x.pcd.bin" -> "x".
std::string stem_of(const fs::path& file) {
  fs::path stem = file.stem();
  return text::lower_case(stem.extension().string()) == ".pcd" ? stem.stem().string() : stem.string();
}

/// The numbers in the names when all are small whole numbers, else 0, 1, 2, ...
std::vector<std::size_t> frame_numbers_of(const std::vector<fs::path>& files) {
  std::vector<std::size_t> numbers;
  for (const fs::path& file : files) {
    const auto number = text::parse_whole(stem_of(file));
    if (!number || *number > kLargestFrame || (!numbers.empty() && *number <= numbers.back())) {
      break;
    }
    numbers.push_back(static_cast<std::size_t>(*number));
  }
  if (numbers.size() != files.size()) {
    numbers.resize(files.size());
    for (std::size_t i = 0; i < files.size(); ++i) {
      numbers[i] = i;
    }
  }
  return numbers;
}

std::string rate_text(double rate_hz) { return format_text("rate %g Hz", rate_hz); }

/// Files in the order of the times in their names, with these times.
void order_by_stamps(FileLogParts& parts) {
  std::vector<std::size_t> order(parts.files.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return parts.stamps_s[a] < parts.stamps_s[b]; });
  std::vector<fs::path> files;
  std::vector<double> stamps_s;
  for (const std::size_t i : order) {
    files.push_back(parts.files[i]);
    stamps_s.push_back(parts.stamps_s[i]);
  }
  parts.files = std::move(files);
  parts.stamps_s = std::move(stamps_s);
}

void stamps_by_names_or_rate(FileLogParts& parts) {
  parts.stamps_s = stamps_in_names(parts.files);
  parts.info.stamps_given = !parts.stamps_s.empty();
  parts.info.stamps_source = parts.info.stamps_given ? "file names" : rate_text(parts.options.rate_hz);
  if (parts.info.stamps_given) {
    order_by_stamps(parts);
    parts.info.problem = repair_timestamps(parts.stamps_s, parts.files.front().parent_path());
    return;
  }
  // Numbers with few gaps are scans that were dropped; other numbers say nothing about time.
  const std::vector<std::size_t>& numbers = parts.frame_numbers;
  const bool few_gaps = numbers.back() - numbers.front() < 2 * numbers.size();
  parts.stamps_s.resize(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    parts.stamps_s[i] = static_cast<double>(few_gaps ? numbers[i] - numbers.front() : i) / parts.options.rate_hz;
  }
}

void take_sweep(FileLogParts& parts, const fs::path& base) {
  std::error_code error;
  if (fs::is_regular_file(base / "sweep.txt", error)) {
    parts.info.companions.push_back(base / "sweep.txt");
  }
  const SweepHint hint = read_sweep_hint(base / "sweep.txt");
  parts.info.motion_compensated = hint.motion_compensated;
  if (parts.options.rebuild_times == RebuildTimes::kNever) {
    return;
  }
  if (hint.motion_compensated != true) {
    parts.info.sweep = hint.model;  // the points of a compensated scan need no times
  }
  if (parts.options.rebuild_times != RebuildTimes::kAuto) {
    cloud::SweepModel model = hint.model.value_or(cloud::SweepModel{});
    model.clockwise = parts.options.rebuild_times == RebuildTimes::kClockwise;
    model.period_s = hint.model ? model.period_s : 1.0 / parts.options.rate_hz;
    parts.info.sweep = model;
  }
}

/// Places of a longest strictly rising subsequence (patience sorting).
std::vector<std::size_t> longest_rise(const std::vector<double>& values) {
  std::vector<std::size_t> ends;  // of the rises of each length, the place of the lowest last value
  std::vector<std::size_t> before(values.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto at = std::lower_bound(ends.begin(), ends.end(), values[i],
                                     [&](std::size_t end, double value) { return values[end] < value; });
    before[i] = at == ends.begin() ? values.size() : *(at - 1);
    if (at == ends.end()) {
      ends.push_back(i);
    } else if (values[i] < values[*at]) {
      *at = i;
    }
  }
  std::vector<std::size_t> rise;
  for (std::size_t i = ends.empty() ? values.size() : ends.back(); i < values.size(); i = before[i]) {
    rise.push_back(i);
  }
  std::reverse(rise.begin(), rise.end());
  return rise;
}

std::size_t first_missing(const std::vector<std::size_t>& places) {
  std::size_t i = 0;
  while (i < places.size() && places[i] == i) {
    ++i;
  }
  return i;
}

double stamp_of_line(std::string_view line, const fs::path& file, std::size_t number) {
  const std::vector<std::string_view> words = text::split_words(line, ',');
  std::optional<double> stamp = words.empty() ? std::nullopt : text::parse_number(words.front());
  if (!stamp) {
    stamp = parse_date_time(line);
  }
  if (!stamp || !std::isfinite(*stamp)) {
    throw InputError(file.string(), std::to_string(number), "'" + std::string(line) + "' is no time");
  }
  return *stamp > 1e17 ? *stamp * 1e-9 : *stamp;
}

}  // namespace

std::string point_file_kind(const fs::path& file) {
  const std::string extension = text::lower_case(file.extension().string());
  return extension == ".bin" || extension == ".pcd" || extension == ".ply" ? extension.substr(1) : "";
}

std::vector<fs::path> list_point_files(const fs::path& folder) {
  std::map<std::string, std::vector<fs::path>> by_kind;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string kind = point_file_kind(it->path());
    if (!kind.empty() && it->path().filename().string().front() != '.' && it->is_regular_file(error)) {
      by_kind[kind].push_back(it->path());
    }
  }
  std::vector<fs::path> files;
  for (auto& [kind, some] : by_kind) {
    if (some.size() > files.size()) {
      files.swap(some);
    }
  }
  if (by_kind.size() > 1) {
    log(Severity::kWarning, folder.string() + ": point files of several kinds; only the ." +
                                point_file_kind(files.front()) + " files are read");
  }
  std::sort(files.begin(), files.end(), by_name);
  return files;
}

std::vector<fs::path> list_folders(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_directory(error)) {
      folders.push_back(it->path());
    }
  }
  std::sort(folders.begin(), folders.end(), by_name);
  return folders;
}

FileLogParts parts_of_files(std::vector<fs::path> files, const fs::path& base, const LogOptions& options) {
  FileLogParts parts;
  parts.files = std::move(files);
  parts.options = options;
  parts.frame_numbers = frame_numbers_of(parts.files);
  take_sweep(parts, base);
  stamps_by_names_or_rate(parts);
  return parts;
}

std::optional<std::vector<std::size_t>> rows_of_scans(const FileLogParts& parts, std::size_t rows) {
  std::vector<std::size_t> row_of_scan(parts.files.size());
  const bool in_order = rows == parts.files.size();
  if (!in_order && parts.frame_numbers.back() >= rows) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < row_of_scan.size(); ++i) {
    row_of_scan[i] = in_order ? i : parts.frame_numbers[i];
  }
  // Scans numbered from 0 without gaps do not say which rows of a longer table are theirs: the first ones.
  return row_of_scan;
}

void take_stamps(FileLogParts& parts, const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return;
  }
  const std::string text = storage::read_file(file);
  std::vector<double> stamps;
  std::size_t number = 0;
  for (const std::string_view line : text::split_lines(text)) {
    ++number;
    if (!text::split_words(line).empty() && line.front() != '#') {
      stamps.push_back(stamp_of_line(line, file, number));
    }
  }
  const auto rows = rows_of_scans(parts, stamps.size());
  if (!rows) {
    throw InputError(file.string(), "",
                     std::to_string(stamps.size()) + " times for " + std::to_string(parts.files.size()) + " scans",
                     "give one line a scan, or move the file away and state the rate");
  }
  for (std::size_t i = 0; i < rows->size(); ++i) {
    parts.stamps_s[i] = stamps[(*rows)[i]];
  }
  parts.info.problem = repair_timestamps(parts.stamps_s, file);
  parts.info.companions.push_back(file);
  parts.info.stamps_given = true;
  parts.info.stamps_source = file.filename().string();
}

std::string repair_timestamps(std::vector<double>& stamps_s, const fs::path& file) {
  const std::vector<std::size_t> kept = longest_rise(stamps_s);
  if (kept.size() == stamps_s.size()) {
    return "";
  }
  const std::size_t first = first_missing(kept);
  const double step_s = kept.size() > 1 ? (stamps_s[kept.back()] - stamps_s[kept.front()]) /
                                              static_cast<double>(kept.back() - kept.front())
                                        : kUsualStep_s;
  std::size_t next = 0;  // of the kept ones, the first that is not before the scan
  for (std::size_t i = 0; i < stamps_s.size(); ++i) {
    next += next < kept.size() && kept[next] < i ? 1 : 0;
    if (next < kept.size() && kept[next] == i) {
      continue;
    }
    if (next == 0) {
      stamps_s[i] = stamps_s[kept[0]] - step_s * static_cast<double>(kept[0] - i);
    } else if (next == kept.size()) {
      stamps_s[i] = stamps_s[i - 1] + step_s;
    } else {
      stamps_s[i] =
          stamps_s[i - 1] + (stamps_s[kept[next]] - stamps_s[i - 1]) / static_cast<double>(kept[next] - i + 1);
    }
  }
  const std::string problem = std::to_string(stamps_s.size() - kept.size()) +
                              " times do not rise with the scans, the first is that of scan " + std::to_string(first) +
                              "; times between those of their neighbours are taken instead";
  log(Severity::kWarning, file.string() + ": " + problem);
  return problem;
}

namespace {

void take_truth_by_time(FileLogParts& parts, const Trajectory& trajectory, const fs::path& file) {
  try {
    parts.truth = poses_of_scans(trajectory, parts.stamps_s, file.string());
  } catch (const InputError& problem) {
    parts.info.truth_problem = std::string(problem.what()) + "; they are not used";
    log(Severity::kWarning, parts.info.truth_problem);
    return;
  }
  parts.info.truth_given = true;
  parts.info.truth_source = file.string();
  parts.info.companions.push_back(file);
}

}  // namespace

void take_truth(FileLogParts& parts, const fs::path& file, const std::optional<Pose>& T_camera_lidar) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return;
  }
  const Trajectory trajectory = read_trajectory(file);
  if (!trajectory.stamps_s.empty()) {
    take_truth_by_time(parts, trajectory, file);
    return;
  }
  const std::vector<Pose>& poses = trajectory.poses;
  const auto rows = rows_of_scans(parts, poses.size());
  if (!rows) {
    parts.info.truth_problem = file.string() + ": " + std::to_string(poses.size()) + " poses for " +
                               std::to_string(parts.files.size()) + " scans; they are not used";
    log(Severity::kWarning, parts.info.truth_problem);
    return;
  }
  for (const std::size_t row : *rows) {
    const Pose& pose = poses[row];
    parts.truth.push_back(T_camera_lidar ? T_camera_lidar->inverse() * pose * *T_camera_lidar : pose);
  }
  parts.info.truth_given = true;
  parts.info.truth_source = file.string();
  parts.info.companions.push_back(file);
}

void take_truth_interpolated(FileLogParts& parts, const std::vector<double>& stamps_s, const std::vector<Pose>& poses,
                             const std::string& source) {
  const Trajectory trajectory{stamps_s, poses};
  if (poses.empty() || !std::is_sorted(stamps_s.begin(), stamps_s.end())) {
    parts.info.truth_problem = source + ": no poses, or their times do not rise; they are not used";
    log(Severity::kWarning, parts.info.truth_problem);
    return;
  }
  for (const double stamp : parts.stamps_s) {
    parts.truth.push_back(pose_at(trajectory, stamp));
  }
  parts.info.truth_given = true;
  parts.info.truth_source = source;
}

std::optional<double> parse_date_time(std::string_view text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, read = 0;
  double second = 0.0;
  char seconds[24] = "";
  const std::string plain(text);
  const char* const kForms[] = {"%4d-%2d-%2d %2d:%2d:%23[0-9.]%n", "%4d-%2d-%2dT%2d:%2d:%23[0-9.]%n"};
  for (const char* form : kForms) {
    read = 0;
    if (std::sscanf(plain.c_str(), form, &year, &month, &day, &hour, &minute, seconds, &read) == 6 && read > 0) {
      second = text::parse_number(seconds).value_or(-1.0);
      read = second >= 0.0 ? read : 0;
      break;
    }
    read = 0;
  }
  int whole_second = 0, millisecond = 0;
  if (read == 0 && std::sscanf(plain.c_str(), "%4d-%2d-%2d-%2d-%2d-%2d-%3d%n", &year, &month, &day, &hour, &minute,
                               &whole_second, &millisecond, &read) == 7) {
    second = whole_second + millisecond * 1e-3;
  }
  const auto date = std::chrono::year(year) / month / day;
  if (read == 0 || static_cast<std::size_t>(read) != plain.size() || !date.ok()) {
    return std::nullopt;
  }
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return static_cast<double>(days) * 86400.0 + hour * 3600.0 + minute * 60.0 + second;
}

std::optional<double> stamp_in_name(const fs::path& file) {
  const std::string stem = stem_of(file);
  if (const auto date = parse_date_time(stem)) {
    return date;
  }
  if (const auto whole = text::parse_whole(stem)) {
    if (stem.size() < 16 || stem.size() > 19) {
      return std::nullopt;
    }
    return static_cast<double>(*whole) * (stem.size() >= 18 ? 1e-9 : 1e-6);
  }
  const auto seconds = text::parse_number(stem);
  return seconds && *seconds > 1e8 && *seconds < 1e11 ? seconds : std::nullopt;
}

namespace {

/// The whole seconds and the digits behind the point of a name like 1741286117.605000000; nothing for other names.
struct NamedTime {
  double seconds = 0.0;
  std::string fraction;
};

std::optional<NamedTime> named_time(const fs::path& file) {
  const std::string stem = stem_of(file);
  const std::size_t point = stem.find('.');
  if (point == std::string::npos || point + 1 == stem.size()) {
    return std::nullopt;
  }
  const std::string fraction = stem.substr(point + 1);
  const auto seconds = text::parse_whole(stem.substr(0, point));
  if (!seconds || fraction.size() > 9 || fraction.find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  return NamedTime{static_cast<double>(*seconds), fraction};
}

/// Whether the digits behind the point count nanoseconds and were not padded to nine. Digits of one length are a
/// decimal fraction. A program that writes fractions short leaves out their last zeros, and has no nine digits to give
/// for seconds since 1970 (a double has seven): ends with zeros, or eight or nine digits, are whole nanoseconds.
bool unpadded_nanoseconds(const std::vector<NamedTime>& times) {
  std::size_t shortest = 9;
  std::size_t longest = 0;
  for (const NamedTime& time : times) {
    shortest = std::min(shortest, time.fraction.size());
    longest = std::max(longest, time.fraction.size());
  }
  const bool zeros_at_the_end = std::any_of(times.begin(), times.end(), [&](const NamedTime& time) {
    return time.fraction.size() > 1 && time.fraction.size() < longest && time.fraction.back() == '0';
  });
  return shortest < longest && (longest > 7 || zeros_at_the_end);
}

}  // namespace

std::vector<double> stamps_in_names(const std::vector<fs::path>& files) {
  std::vector<double> stamps_s;
  std::vector<NamedTime> named;
  for (const fs::path& file : files) {
    const auto stamp = stamp_in_name(file);
    if (!stamp) {
      return {};
    }
    stamps_s.push_back(*stamp);
    if (const auto time = named_time(file)) {
      named.push_back(*time);
    }
  }
  if (named.size() == files.size() && unpadded_nanoseconds(named)) {
    for (std::size_t i = 0; i < files.size(); ++i) {
      stamps_s[i] = named[i].seconds + 1e-9 * std::stod(named[i].fraction);
    }
  }
  return stamps_s;
}

}  // namespace loopmark::io::internal
