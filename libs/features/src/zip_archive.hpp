// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace loopmark::features::internal {

/// The members of a ZIP archive (stored or deflated), by name. Throws InputError naming `file` and the member; also
/// where members overlap or unpack to more than 512 MiB together, as in an archive made to fill the memory.
std::map<std::string, std::string> unzip(std::string_view bytes, const std::string& file);

}  // namespace loopmark::features::internal
