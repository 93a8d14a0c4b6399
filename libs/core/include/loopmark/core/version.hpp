// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace loopmark {

/// The version of loopmark, "MAJOR.MINOR.PATCH".
const char* version();

}  // namespace loopmark
