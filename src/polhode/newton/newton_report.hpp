// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/equations/constraint_check.hpp>

namespace polhode {

/// Outcome of a Newton solve. Failure to converge is an outcome, not an exception: the stepper may
/// halve the step and try again.
struct NewtonReport {
  bool converged = false;
  double t = 0.0;   ///< Start of the step [s].
  double dt = 0.0;  ///< [s]
  int iterations = 0;
  std::vector<double> increments;  ///< Largest scaled increment, one per iteration [-].
  double rotation = 0.0;           ///< Largest |Θ| in the step [-].
  /// Accepted beyond its iteration limit, with a leak of the multipliers above its tolerance.
  bool hard = false;
  /// Multipliers do work at open rows that neither rounding nor a singular position explains.
  bool leaks = false;
  /// Largest increment that was accepted as rounding though it was not small against its tolerance;
  /// 0 if there was none [-].
  double rounding = 0.0;
  std::string reason;  ///< If not converged: "converges too slowly", ...
  std::string worst;   ///< Location of the largest increment: "body 'forearm'".
  ConstraintCheck constraints;
  [[nodiscard]] std::string text() const;  ///< One paragraph, with a hint what to try next.
};

}  // namespace polhode
