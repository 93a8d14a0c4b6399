// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/trajectory.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

void trajectory(std::string_view bytes) {
  reading([&] { io::read_trajectory(written("trajectory.txt", bytes)); });
}

}  // namespace loopmark::fuzz
