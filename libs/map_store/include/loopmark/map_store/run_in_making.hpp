// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <utility>

#include "loopmark/map_store/run_folder.hpp"

namespace loopmark::map_store {

/// A run folder that is removed again unless it is finished: for what is made from other runs and cannot be resumed.
class RunInMaking {
 public:
  explicit RunInMaking(RunFolder folder) : folder_(std::move(folder)) {}
  ~RunInMaking() {
    if (!finished_) {
      std::error_code ignored;
      std::filesystem::remove_all(folder_.path(), ignored);
    }
  }
  RunInMaking(const RunInMaking&) = delete;
  RunInMaking& operator=(const RunInMaking&) = delete;

  const RunFolder& folder() const { return folder_; }

  /// Gives the run its name.
  void finish() {
    folder_.finish();
    finished_ = true;
  }

  /// The same for a revision (see RunFolder::revise); returns where the old run went.
  std::filesystem::path finish_revision() {
    std::filesystem::path before = folder_.finish_revision();
    finished_ = true;
    return before;
  }

 private:
  RunFolder folder_;
  bool finished_ = false;
};

}  // namespace loopmark::map_store
