// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/evidence_text.hpp"

#include <algorithm>

#include "loopmark/core/number_text.hpp"

namespace loopmark::registration {
namespace {

std::string meaning_of(const std::string& name) {
  for (const EvidenceName& row : evidence_names()) {
    if (name == row.name) {
      return row.meaning;
    }
  }
  return "";
}

}  // namespace

const std::vector<EvidenceName>& evidence_names() {
  static const std::vector<EvidenceName> names = {
      {"agreement", "share of the structure within 0.4 m of a surfel of the other scan"},
      {"low_missing", "low structure where the other scan's beams met something else (ln of the share)"},
      {"tall_strong_violation", "tall structure that all beams around pass through (ln of the share)"},
      {"object_strong_violation", "single low objects that all beams around pass through (ln of the share)"},
      {"far_violation", "structure over 25 m away that beams pass through (ln of the share)"},
      {"contradicted", "5 m cells of which most is contradicted (ln of 1 + count)"},
      {"tall_contradicted", "5 m cells of which most tall structure is contradicted (ln of 1 + count)"},
      {"residual", "distance left between aligned surfels, metres"},
      {"objects", "single objects that both scans show (ln)"},
      {"peak", "height of the peak in the correlation of the bird's-eye views"},
      {"rise", "that peak above what chance gives (ln)"},
      {"ground", "ground that both scans show (ln)"},
      {"ground_gap", "distance left between the shared grounds, metres"},
      {"proximity", "nearness of the sensors: exp(-distance / 10 m)"},
      {"structure_fewer", "tells the scene: surfels of structure of the scan with fewer (ln)"},
      {"structure_more", "tells the scene: the same of the other scan (ln)"},
      {"density_ratio", "tells the scene: fine surfels in a coarse one, scan with fewer (ln)"},
      {"density_ratio_more", "tells the scene: the same of the other scan (ln)"},
      {"log_odds", "all of it weighed: above 0 speaks for the motion"}};
  return names;
}

std::string evidence_table(const std::vector<RegistrationMode>& modes, std::size_t most) {
  const std::size_t columns = std::min(most, modes.size());
  if (columns == 0 || modes.front().evidence.empty()) {
    return "";
  }
  std::string text = "  evidence               ";
  for (std::size_t m = 0; m < columns; ++m) {
    text += format_text("   mode %zu", m + 1);
  }
  text += "\n";
  for (std::size_t k = 0; k < modes.front().evidence.size(); ++k) {
    const std::string& name = modes.front().evidence[k].first;
    text += format_text("  %-23s", name.c_str());
    for (std::size_t m = 0; m < columns; ++m) {
      text += format_text(" %8.3g", modes[m].evidence.at(k).second);
    }
    text += "  " + meaning_of(name) + "\n";
  }
  return text;
}

}  // namespace loopmark::registration
