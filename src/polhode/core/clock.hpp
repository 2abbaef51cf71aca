// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <ctime>

namespace polhode {

/// Time since an arbitrary start [s].
[[nodiscard]] inline double wall_clock() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

/// Processor time of the program, all threads [s].
[[nodiscard]] inline double cpu_clock() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace polhode
