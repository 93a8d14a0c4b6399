// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evidence_words.hpp"

#include <map>

namespace loopmark::map_page::internal {

EvidenceWords evidence_words(const std::string& name) {
  static const std::map<std::string, EvidenceWords> kWords = {
      {"agreement", {"structure of each scan that the other one has, too", "share; more is better"}},
      {"low_missing",
       {"low structure (below 2.2 m) that the other scan should have seen", "log of against to for; less is better"}},
      {"tall_strong_violation",
       {"tall structure through which the other scan's beams all passed", "log of against to for; less is better"}},
      {"object_strong_violation",
       {"cars, hedges and bins through which beams passed", "log of against to for; less is better"}},
      {"far_violation", {"structure beyond 25 m through which beams passed", "log of against to for; less is better"}},
      {"contradicted", {"squares of 5 m in which most structure is contradicted", "log(1 + count); less is better"}},
      {"tall_contradicted",
       {"squares of 5 m in which most tall structure is contradicted", "log(1 + count); less is better"}},
      {"residual", {"distance of surfaces that were laid on each other", "metres; less is better"}},
      {"objects", {"cars, hedges and bins that both scans have", "log(1 + count); more is better"}},
      {"peak", {"height of the peak when the views from above were correlated", "standard deviations; more is better"}},
      {"rise", {"that peak against what chance gives for this pair", "log of the ratio; more is better"}},
      {"ground", {"ground that both scans share", "log(1 + count); more is better"}},
      {"ground_gap", {"distance between the two grounds", "metres; less is better"}},
      {"near", {"nearness of the two sensors", "exp(-distance / 10 m); 1 is the same place"}},
      {"fewer", {"structure in the scan that has less", "log(1 + count); tells how much could be asked"}},
      {"more", {"structure in the scan that has more", "log(1 + count); tells how much could be asked"}},
      {"fill", {"density of the sparser scan", "log of fine to coarse surface surfels; describes the pair"}},
      {"density_ratio_more",
       {"density of the denser scan", "log of fine to coarse surface surfels; describes the pair"}}};
  const auto found = kWords.find(name);
  return found == kWords.end() ? EvidenceWords{name, ""} : found->second;
}

}  // namespace loopmark::map_page::internal
