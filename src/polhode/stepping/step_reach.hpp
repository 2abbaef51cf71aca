// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace polhode {

/// Comparison of the estimated errors of automatic steps with the requested ones.
class StepReach {
 public:
  /// Adds an accepted step. @param noise  Accepted because shorter steps have no smaller error.
  void count(double t, double error, double asked, bool noise);
  /// Warnings of a run: none, or one sentence with what to do.
  [[nodiscard]] std::vector<std::string> warnings(double tolerance, int order) const;

 private:
  std::int64_t steps_ = 0, beyond_ = 0;
  double sum_ = 0.0, worst_ = 0.0, first_ = 0.0;
};

}  // namespace polhode
