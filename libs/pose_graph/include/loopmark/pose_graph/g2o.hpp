// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Pose graphs in the text format of g2o (VERTEX_SE3:QUAT, EDGE_SE3:QUAT, FIX).
#pragma once

#include <filesystem>

#include "loopmark/pose_graph/pose_graph.hpp"

namespace loopmark::pose_graph {

/// Writes the graph so that g2o's own tools solve the same problem: their error is [translation; vector part
/// of the quaternion] on the right of the measurement, so information matrices are carried over by the
/// adjoint and the factor two. A comment line "# loop" or "# forced" before an edge keeps its kind.
void write_g2o(const std::filesystem::path& path, const PoseGraph& graph);

/// Reads such a file. Edges without a kind are odometry between consecutive vertices, else loops. Vertex ids
/// become indices in increasing order. Throws InputError with file, line and problem.
PoseGraph read_g2o(const std::filesystem::path& path);

}  // namespace loopmark::pose_graph
