// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// How far the assembled tangent is from central differences of the assembled residual.
struct TangentReport {
  double error = 0.0;     ///< Largest difference, relative to the largest entry of its row [-].
  double analytic = 0.0;  ///< The entry where it is, of the scaled system.
  double numeric = 0.0;
  std::string row;       ///< "moment y of body 'arm'", or "row 2 of joint 'elbow'".
  std::string column;    ///< "turn about y of body 'arm'", or "multiplier 2 of joint 'elbow'".
  int bodies_moved = 0;  ///< Bodies whose columns were compared.
  [[nodiscard]] std::string text() const;
};

/// Differences of first-order quality agree to about this much.
inline constexpr double kTangentTolerance = 1e-6;

/// Compares the tangent of one step from a state with central differences. The step is the one
/// that goes on with the velocities of the state; multipliers are those of the state, and where
/// they are all zero, weights of the bodies, so that no geometric stiffness goes unseen.
///
/// @param most_bodies  At most so many bodies are moved, evenly chosen: time grows with its square.
[[nodiscard]] TangentReport check_tangents(const System& system, const State& state, double dt,
                                           double rho_inf,
                                           MomentumRate form = MomentumRate::momentum,
                                           int most_bodies = 200);

}  // namespace polhode
