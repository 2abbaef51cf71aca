// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace polhode::cli {

/// Set by Ctrl-C; a run ends after the step it is in. A second Ctrl-C ends the program at once.
extern std::atomic<bool> stop_wanted;

/// Lets SIGINT and SIGTERM set stop_wanted, once.
void catch_stop_signals();

}  // namespace polhode::cli
