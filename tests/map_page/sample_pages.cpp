// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Writes pages of made-up runs for the tests in a browser: sample_pages FOLDER.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "map_page/sample_runs.hpp"

namespace loopmark::testing_support {
namespace {

SampleRun one_scan() {
  SampleRun run;
  run.name = "one scan";
  run.add_scan(Pose::Identity(), true);
  return run;
}

SampleRun without_loops() {
  SampleRun run = scene_run();
  run.name = "no loops";
  run.loops.clear();
  run.map.loops.clear();
  return run;
}

SampleRun evil_name() {
  SampleRun run = scene_run();
  run.name =
      R"(<img src=x onerror="document.title='owned'"></script><script>document.title='owned'</script> & 'quoted')";
  run.scans[5].problem = "<b onmouseover=alert(1)>damaged</b>";
  run.scans[5].state = map_store::ScanState::kDamaged;
  return run;
}

SampleRun long_name() {
  SampleRun run = scene_run();
  run.name =
      "/data/" + std::string(300, 'x') + "/a name of many words that goes on and on and does not end for a long while";
  return run;
}

void write(const std::filesystem::path& folder, const std::string& file, const SampleRun& run) {
  std::ofstream out(folder / (file + ".html"), std::ios::binary);
  map_page::map_page(run.input()).write(out);
}

}  // namespace
}  // namespace loopmark::testing_support

int main(int count, char** words) {
  using namespace loopmark::testing_support;
  if (count != 2) {
    std::fprintf(stderr, "usage: sample_pages FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = words[1];
  std::filesystem::create_directories(folder);
  write(folder, "scene", scene_run());
  write(folder, "one_scan", one_scan());
  write(folder, "no_loops", without_loops());
  write(folder, "evil", evil_name());
  write(folder, "long_name", long_name());
  write(folder, "parts", parts_run(5));
  write(folder, "answers", answered_run());
  write(folder, "town", town_run(40'000, 7'000, 500));
  return 0;
}
