// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace polhode {

/// Report of the consistent start.
struct StartReport {
  double largest_move = 0.0;  ///< Of any body, |Δr|/ℓ or angle [-]; 0 if already assembled.
  std::string moved_body;
  double position_residual = 0.0;  ///< Largest |g| before assembly [m or -].
  double velocity_residual = 0.0;  ///< Largest |G v| before projection [m/s or 1/s].
  double velocity_change = 0.0;    ///< Largest change of a velocity by the projection.
  int iterations = 0;
  bool assembled = true;                 ///< False: the constraints are contradictory.
  std::vector<std::string> unsatisfied;  ///< Contradictory interactions: "joint 'elbow'".
  bool consistent = true;  ///< False: the velocities are not compatible with a singular position.
};

}  // namespace polhode
