// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the page knows of scans, keyframes and loops, as columns.
#pragma once

#include <string>
#include <vector>

#include "loopmark/map_page/findings.hpp"

namespace loopmark::map_page::internal {

/// Words by number, each once.
class Dictionary {
 public:
  std::size_t number(const std::string& word);
  const std::vector<std::string>& words() const { return words_; }

 private:
  std::vector<std::string> words_;
};

/// Words that the columns of loops refer to.
struct LoopWords {
  Dictionary origins;
  Dictionary reasons;
  std::vector<std::string> evidence;  ///< names, in the order in which they first occur
};

std::string scan_blocks(const MapRecords& records);
std::string keyframe_blocks(const MapRecords& records);
std::string loop_blocks(const MapRecords& records, LoopWords& words);

}  // namespace loopmark::map_page::internal
