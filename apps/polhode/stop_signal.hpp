// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace polhode::cli {

/// Set by Ctrl-C; a run ends after the current step. A second Ctrl-C ends the program at once.
extern std::atomic<bool> stop_wanted;

/// Set with stop_wanted at the end of the time given to stop_after().
extern std::atomic<bool> wall_limit_reached;

/// Stops as Ctrl-C does after this wall time, also within a step [s].
void stop_after(double seconds);

/// Installs handlers of SIGINT, SIGTERM and, unless it is ignored, SIGHUP that set stop_wanted,
/// once.
void catch_stop_signals();

}  // namespace polhode::cli
