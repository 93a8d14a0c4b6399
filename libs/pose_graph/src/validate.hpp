// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/pose_graph/pose_graph.hpp"

namespace loopmark::pose_graph::internal {

/// Throws InputError naming the node or edge whose numbers make no sense.
void validate(const PoseGraph& graph);

}  // namespace loopmark::pose_graph::internal
