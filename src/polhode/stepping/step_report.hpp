// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/newton/newton_report.hpp>

namespace polhode {

/// Result of one call of Stepper::advance.
struct StepReport {
  bool accepted = false;
  double t = 0.0;       ///< Time reached [s].
  double dt = 0.0;      ///< Length of the accepted step [s].
  int rejected = 0;     ///< Rejected trials.
  NewtonReport newton;  ///< Of the last trial.
  std::string message;  ///< If not accepted: what happened, where, and a hint what to try.
};

}  // namespace polhode
