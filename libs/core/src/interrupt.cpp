// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <cstdlib>

#include "loopmark/core/error.hpp"

namespace loopmark {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the flag is set in a signal handler");

extern "C" void on_signal(int /*signal*/) {
  if (requested.exchange(true)) {
    std::_Exit(static_cast<int>(ExitCode::kInterrupted));
  }
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigemptyset(&action.sa_mask);
  action.sa_flags = 0;  // a call that waits, such as opening a pipe, ends with the first signal
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (signal != SIGHUP || before.sa_handler != SIG_IGN) {  // nohup
      ::sigaction(signal, &action, nullptr);
    }
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of writing, which names the file
}

bool interrupt_requested() { return requested.load(); }

void request_interrupt(bool value) { requested.store(value); }

void check_interrupt() {
  if (interrupt_requested()) {
    throw Interrupted();
  }
}

}  // namespace loopmark
