// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Which source the program was built from.
#pragma once

#include <string>

namespace loopmark::app {

/// The git commit, with "+changes" where the working tree had some; empty outside a git checkout.
std::string commit();

/// "0.2.0 (commit 0123456789ab)", without the bracket where the commit is not known.
std::string version_text();

}  // namespace loopmark::app
