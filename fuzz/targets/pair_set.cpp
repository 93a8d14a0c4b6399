// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pair_sets/pair_set.hpp"

#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

void pair_set(std::string_view bytes) {
  const std::filesystem::path file = written("pairs.txt", bytes);
  reading([&] { pair_sets::read_pair_set(file); });
  reading([&] { pair_sets::read_negatives(file); });
  reading([&] { pair_sets::read_motions(file); });
}

}  // namespace loopmark::fuzz
