// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/version.hpp"

namespace loopmark {

const char* version() { return LOOPMARK_VERSION; }

}  // namespace loopmark
