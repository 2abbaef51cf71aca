// SPDX-License-Identifier: Apache-2.0
#include "stop_signal.hpp"

#include <csignal>

namespace polhode::cli {

std::atomic<bool> stop_wanted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

void catch_stop_signals() {
  struct sigaction action = {};
  action.sa_handler = [](int) { stop_wanted = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
  // The end of a session; a program that nohup started ignores it on purpose.
  struct sigaction present = {};
  if (sigaction(SIGHUP, nullptr, &present) == 0 && present.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
}

}  // namespace polhode::cli
