// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "commit.hpp"

#include "loopmark/core/version.hpp"
#include "loopmark_commit.inc"  // written by cmake/LoopmarkCommit.cmake at each build

namespace loopmark::app {

std::string commit() { return LOOPMARK_COMMIT; }

std::string version_text() {
  const std::string text = version();
  return commit().empty() ? text : text + " (commit " + commit() + ")";
}

}  // namespace loopmark::app
