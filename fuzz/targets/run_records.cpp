// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "loopmark/core/number_text.hpp"
#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/multi_session/session_set.hpp"
#include "loopmark/storage/files.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {
namespace {

std::string with_checksums(std::string_view lines) {
  std::string content;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view line = lines.substr(0, end);
    content += format_text("%08x ", storage::crc32(line)) + std::string(line) + "\n";
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return content;
}

}  // namespace

/// What merging does with the records of a run.
void run_records(std::string_view bytes) {
  static const map_store::RunFolder run = map_store::RunFolder::create(scratch() / "run");
  constexpr std::array kNames = {"scans", "loops", "sessions", "decisions"};
  const std::vector<std::string_view> content = parts(bytes, kNames.size());
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    written("run.partial/records/" + std::string(kNames[i]) + ".rec", with_checksums(content[i]));
  }
  written("run.partial/manifest.json", R"({"input": {"log": "x"}})");
  reading([] {
    multi_session::SessionSet set = multi_session::read_session_set(run);
    set.session_of_keyframe();
    std::vector<bool> keep(set.drives.size(), false);
    keep.back() = true;
    const multi_session::SessionSet last = multi_session::selected(set, keep);
    mapping::keyframes_of(set.scans);
    multi_session::SessionSet joined;
    append(std::move(set), joined);
  });
}

}  // namespace loopmark::fuzz
