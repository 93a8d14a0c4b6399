// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace loopmark {

/// Makes SIGINT and SIGTERM set a flag instead of ending the process; a second one ends it at once. A limit on the size
/// of files (SIGXFSZ) becomes an error of writing.
void install_interrupt_handler();

/// True once the user has asked to stop.
bool interrupt_requested();

/// Throws Interrupted when the user has asked to stop. Call it between units of work.
void check_interrupt();

/// Sets or clears the flag (tests, embedding programs).
void request_interrupt(bool value = true);

}  // namespace loopmark
