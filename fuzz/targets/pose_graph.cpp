// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pose_graph/g2o.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

void pose_graph(std::string_view bytes) {
  reading([&] { pose_graph::read_g2o(written("graph.g2o", bytes)); });
}

}  // namespace loopmark::fuzz
