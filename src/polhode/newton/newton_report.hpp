// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/equations/constraint_check.hpp>

namespace polhode {

/// How a Newton solve went. Not to converge is an outcome, not an exception: the stepper may
/// halve the step and try again.
struct NewtonReport {
  bool converged = false;
  double t = 0.0;   ///< Start of the step [s].
  double dt = 0.0;  ///< [s]
  int iterations = 0;
  std::vector<double> increments;  ///< Largest scaled increment, one per iteration [-].
  double rotation = 0.0;           ///< Largest |Θ| of the step [-].
  bool hard = false;   ///< Converged, but slowly: it needed more iterations than it has.
  std::string reason;  ///< If not converged: "contracts too slowly", "turns too far" ...
  std::string worst;   ///< Largest increment: "body 'forearm'".
  ConstraintCheck constraints;
  [[nodiscard]] std::string text() const;  ///< One paragraph, with what to try next.
};

}  // namespace polhode
