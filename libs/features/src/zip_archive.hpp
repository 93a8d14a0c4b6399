// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace loopmark::features::internal {

/// The members of a ZIP archive (stored or deflated), by name. Throws InputError naming `file` and the member.
std::map<std::string, std::string> unzip(std::string_view bytes, const std::string& file);

}  // namespace loopmark::features::internal
