// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Reading one scan of 120 000 points from each kind of file (in the page cache).
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "loopmark/core/random.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"

namespace loopmark {
namespace {

namespace fs = std::filesystem;

PointCloud scan_of_120k_points(bool with_channels) {
  Rng rng(1);
  PointCloud cloud;
  for (std::size_t i = 0; i < 120'000; ++i) {
    cloud.points.emplace_back(static_cast<float>(rng.uniform(-80, 80)), static_cast<float>(rng.uniform(-80, 80)),
                              static_cast<float>(rng.uniform(-2, 10)));
    cloud.intensity.push_back(static_cast<float>(rng.below(256)));
    if (with_channels) {
      cloud.ring.push_back(static_cast<std::uint16_t>(i % 64));
      cloud.time_offset_s.push_back(static_cast<float>(i) * 8e-7F);
    }
  }
  return cloud;
}

/// A file that is gone at the end of the benchmark.
struct TemporaryFile {
  explicit TemporaryFile(const char* extension)
      : path(fs::temp_directory_path() / ("loopmark_benchmark_" + std::to_string(::getpid()) + extension)) {}
  ~TemporaryFile() { fs::remove(path); }
  fs::path path;
};

void read_again_and_again(benchmark::State& state, const fs::path& path) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(read_point_file(path).cloud.points.data());
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * fs::file_size(path)));
}

void BM_ReadBin(benchmark::State& state) {
  const TemporaryFile file(".bin");
  write_bin(file.path, scan_of_120k_points(false));
  read_again_and_again(state, file.path);
}
BENCHMARK(BM_ReadBin)->Unit(benchmark::kMillisecond);

void BM_ReadPcd(benchmark::State& state) {
  const TemporaryFile file(".pcd");
  write_pcd(file.path, scan_of_120k_points(state.range(0) != 0));
  read_again_and_again(state, file.path);
}
BENCHMARK(BM_ReadPcd)->ArgName("ring_and_time")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void BM_ReadPly(benchmark::State& state) {
  const TemporaryFile file(".ply");
  write_ply(file.path, scan_of_120k_points(false));
  read_again_and_again(state, file.path);
}
BENCHMARK(BM_ReadPly)->Unit(benchmark::kMillisecond);

void BM_ReadRawlog(benchmark::State& state) {
  const TemporaryFile file(".rawlog");
  RawlogWriter writer(file.path, "top");
  for (std::size_t i = 0; i < 10; ++i) {
    writer.add({i, 0.1 * static_cast<double>(i), scan_of_120k_points(true)});
  }
  writer.finish();
  const RawlogReader reader(file.path, "");
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(reader.read(next++ % 10).points.data());
  }
}
BENCHMARK(BM_ReadRawlog)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopmark

BENCHMARK_MAIN();
