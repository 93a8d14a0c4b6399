// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Every seed of fuzzing, as it is and damaged in a few hundred ways that are the same each time: a reader either takes
/// it or throws InputError. What fuzzing found stays here as a seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "loopmark/core/random.hpp"
#include "loopmark/storage/files.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr int kDamagesOfASeed = 100;

std::vector<fs::path> seeds_of(const Target& target) {
  std::vector<fs::path> seeds;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(LOOPMARK_SOURCE_DIR) / "fuzz/seeds" / target.name)) {
    seeds.push_back(entry.path());
  }
  std::sort(seeds.begin(), seeds.end());
  return seeds;
}

/// Flips bits, cuts, repeats or overwrites a part.
std::string damaged(std::string bytes, Rng& rng) {
  for (std::size_t left = 1 + rng.below(4); left > 0 && !bytes.empty(); --left) {
    const std::size_t at = rng.below(bytes.size());
    const std::size_t length = std::min<std::size_t>(bytes.size() - at, 1 + rng.below(16));
    switch (rng.below(5)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << rng.below(8)));
        break;
      case 1:
        bytes.resize(at);
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 3:
        bytes.replace(at, length, length, rng.below(2) == 0 ? '\xff' : '9');
        break;
      default:
        bytes.erase(at, length);
    }
  }
  return bytes;
}

class Replay : public ::testing::TestWithParam<Target> {};

TEST_P(Replay, SeedsAndTheirDamagesAreTakenOrRefused) {
  const std::vector<fs::path> seeds = seeds_of(GetParam());
  ASSERT_FALSE(seeds.empty());
  for (const fs::path& seed : seeds) {
    SCOPED_TRACE(seed.string());
    const std::string bytes = storage::read_file(seed);
    Rng rng(storage::crc32(bytes));
    EXPECT_NO_THROW(GetParam().read(bytes));
    for (int i = 0; i < kDamagesOfASeed; ++i) {
      const std::string evil = damaged(bytes, rng);
      EXPECT_NO_THROW(GetParam().read(evil)) << "damage " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace loopmark::fuzz
