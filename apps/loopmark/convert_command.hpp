// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command.hpp"

namespace loopmark::app {

Action set_up_convert(CLI::App& command, const Globals& globals);

}  // namespace loopmark::app
