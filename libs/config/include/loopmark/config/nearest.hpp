// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace loopmark::config {

/// The least number of inserted, removed, replaced or swapped neighbouring characters that turns a into b (optimal
/// string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The name most like `name`, the first of equals; empty when none is alike (more than a third of it, at least two
/// characters, would have to change).
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

/// Of dotted `paths`, the one that `path` most probably means: alike as a whole, or ending in a name that is alike
/// ("voxel_m" for "odometry.voxel_m"). Empty when there is none.
std::string nearest_path(const std::string& path, const std::vector<std::string>& paths);

}  // namespace loopmark::config
