// SPDX-License-Identifier: Apache-2.0
#include "stop_signal.hpp"

#include <sys/time.h>

#include <algorithm>
#include <cmath>
#include <csignal>

namespace polhode::cli {

std::atomic<bool> stop_wanted{false}, wall_limit_reached{false};
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

void stop_after(double seconds) {
  struct sigaction action = {};
  action.sa_handler = [](int) { wall_limit_reached = stop_wanted = true; };
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  const double least = 1e-6;  // a timer of no length is switched off
  const double left = std::max(seconds, least), whole = std::floor(left);
  itimerval timer = {};
  timer.it_value.tv_sec = static_cast<time_t>(whole);
  timer.it_value.tv_usec = static_cast<suseconds_t>(std::max(1.0, 1e6 * (left - whole)));
  setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace polhode::cli
