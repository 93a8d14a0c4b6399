// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace loopmark::map_store {

class FolderHold;

/// The folder of a run. While it is made it is called RUN.partial and held by one process; when it is whole it is
/// renamed to RUN.
class RunFolder {
 public:
  /// A new run. What a killed process left as RUN.partial is begun anew unless it can be resumed (records/job.json).
  /// Throws InputError when RUN is there, RUN.partial can be resumed or is held by another process, or cannot be made.
  static RunFolder create(const std::filesystem::path& run);

  /// A run that was interrupted; `run` with or without ".partial". Throws InputError when there is none, and says so
  /// when the run is already whole.
  static RunFolder resume(const std::filesystem::path& run);

  /// A run that is whole. Throws InputError when it is not there or not whole.
  static RunFolder open(const std::filesystem::path& run);

  /// A run that is to take the place of `run`: RUN.partial beside it. Throws InputError when RUN is not whole, and as
  /// create() does.
  static RunFolder revise(const std::filesystem::path& run);

  const std::filesystem::path& path() const { return path_; }  ///< where it is now
  const std::filesystem::path& name() const { return name_; }  ///< where it will be
  std::filesystem::path operator/(const std::string& file) const { return path_ / file; }

  std::filesystem::path scan_records() const { return path_ / "records" / "scans.rec"; }
  std::filesystem::path loop_records() const { return path_ / "records" / "loops.rec"; }
  /// keyframes/000012.pcd: the points; .prepared: what registration needs of them.
  std::filesystem::path keyframe(std::size_t number, const std::string& ending) const;

  /// Gives the run its name, once all of it is on the disk.
  void finish();

  /// The same for a revised run; the one that had the name is kept as RUN.before-1 (or -2, ...), which is returned.
  std::filesystem::path finish_revision();

 private:
  RunFolder(std::filesystem::path path, std::filesystem::path name);
  static RunFolder make(const std::filesystem::path& run);
  void hold();

  std::filesystem::path path_;
  std::filesystem::path name_;
  std::shared_ptr<const FolderHold> hold_;  ///< while it is made
};

}  // namespace loopmark::map_store
