// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Where a library reports to: the program decides what is shown. Libraries never write to std::cout.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace loopmark {

enum class Severity { kDebug, kInfo, kWarning };

/// Receives the messages of the libraries; called from any thread, one at a time.
using LogSink = std::function<void(Severity, const std::string&)>;

/// Replaces the sink; the default writes warnings to standard error.
void set_log_sink(LogSink sink);
void log(Severity severity, const std::string& message);

/// A phase of the work under way: prints a line with its name, what is done, rate and time left to standard error, from
/// the second second on, whether units are finished meanwhile or not: five times a second on a terminal (rewriting the
/// line), every two seconds elsewhere, never when progress is off. Of phases within phases the innermost is shown.
class Progress {
 public:
  /// `phase`: "odometry"; `units`: "scans"; total 0: not known.
  explicit Progress(std::string phase, std::string units = "", std::size_t total = 0);
  /// A phase that its units name.
  Progress(std::string units, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Adds finished units; `note` is shown behind the rate ("12 keyframes, 3 loops").
  void add(std::size_t units = 1, const std::string& note = "");
  /// Ends the line. Called by the destructor too.
  void finish();

  static void set_enabled(bool enabled);

 private:
  struct Line;
  std::unique_ptr<Line> line_;  ///< null once it is finished
};

/// Seconds since it was made or reset.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  void reset() { start_ = std::chrono::steady_clock::now(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace loopmark
