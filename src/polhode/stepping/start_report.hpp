// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace polhode {

/// What the consistent start did.
struct StartReport {
  double largest_move = 0.0;  ///< Of any body, |Δr|/ℓ or angle [-]; 0 if it was assembled.
  std::string moved_body;
  double position_residual = 0.0;  ///< Largest |g| before assembly [m or -].
  double velocity_residual = 0.0;  ///< Largest |G v| before projection [m/s or 1/s].
  double velocity_change = 0.0;    ///< Largest change of a velocity by the projection.
  int iterations = 0;
  bool assembled = true;                 ///< False: the constraints contradict one another.
  std::vector<std::string> unsatisfied;  ///< Interactions that do: "joint 'elbow'".
  bool consistent = true;  ///< False: the velocities fit no motion of a singular position.
};

}  // namespace polhode
