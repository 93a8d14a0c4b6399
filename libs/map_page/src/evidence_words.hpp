// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace loopmark::map_page::internal {

/// A number of the evidence for people.
struct EvidenceWords {
  std::string words;  ///< what was counted or measured
  std::string scale;  ///< in what, and which way it speaks
};

/// The words of registration's evidence by its name; the name itself where it has none here.
EvidenceWords evidence_words(const std::string& name);

}  // namespace loopmark::map_page::internal
