// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <polhode/stepping/step_control.hpp>

namespace polhode {

/// Verdict of an estimate on a step that converged.
struct StepVerdict {
  bool fine = true;
  double factor = 1.0;  ///< Of the length, for the next step or another trial.
  double error = 0.0;
  int columns = 0;     ///< Members of the next extrapolated step; 0: as they are.
  bool noise = false;  ///< Accepted because shorter steps have no smaller error.
  bool kink = false;   ///< Of a step of order 2 that a kink of a force makes too long.
};

/// The last rejected trial with an estimate, for comparison.
struct RefusedStep {
  double H = 0.0, error = 0.0;
  int count = 0;

  /// Whether a shorter step has hardly a smaller error, which then is not the step's own.
  [[nodiscard]] bool leaves_noise(double length, double now) const {
    return H > 0.0 && now > error * std::pow(length / H, step_control::kFalls);
  }
};

}  // namespace polhode
