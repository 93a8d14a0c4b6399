// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace loopmark::map_store {

/// The folder of a run. While it is made it is called RUN.partial; when it is whole it is renamed to RUN.
class RunFolder {
 public:
  /// A new run. Throws InputError when RUN or RUN.partial is there, or cannot be made.
  static RunFolder create(const std::filesystem::path& run);

  /// A run that was interrupted; `run` with or without ".partial". Throws InputError when there is none, and says so
  /// when the run is already whole.
  static RunFolder resume(const std::filesystem::path& run);

  /// A run that is whole. Throws InputError when it is not there or not whole.
  static RunFolder open(const std::filesystem::path& run);

  /// A run that is to take the place of `run`: RUN.partial beside it. Throws InputError when RUN is not whole or
  /// RUN.partial is there.
  static RunFolder revise(const std::filesystem::path& run);

  const std::filesystem::path& path() const { return path_; }  ///< where it is now
  const std::filesystem::path& name() const { return name_; }  ///< where it will be
  std::filesystem::path operator/(const std::string& file) const { return path_ / file; }

  std::filesystem::path scan_records() const { return path_ / "records" / "scans.rec"; }
  std::filesystem::path loop_records() const { return path_ / "records" / "loops.rec"; }
  /// keyframes/000012.pcd: the points; .prepared: what registration needs of them.
  std::filesystem::path keyframe(std::size_t number, const std::string& ending) const;

  /// Gives the run its name.
  void finish();

  /// The same for a revised run; the one that had the name is kept as RUN.before-1 (or -2, ...), which is returned.
  std::filesystem::path finish_revision();

 private:
  RunFolder(std::filesystem::path path, std::filesystem::path name);

  std::filesystem::path path_;
  std::filesystem::path name_;
};

}  // namespace loopmark::map_store
