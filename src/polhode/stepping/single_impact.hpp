// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/core/types.hpp>

namespace polhode {

/// An impact at a single point, in axes along its normal and two tangents.
struct SingleImpact {
  Mat3 mobility;             ///< K: velocity of the point by a unit impulse [1/kg]; symmetric.
  Vec3 velocity;             ///< Of approach: its normal part is negative [m/s].
  double mu = 0.0;           ///< Coefficient of friction along the first tangent.
  double mu_across = 0.0;    ///< Along the second one.
  double restitution = 0.0;  ///< e: e² of the work of compression comes back (Stronge).
  double stored = 0.0;       ///< Energy stored in the point when the impact is taken up [J].
  double kept = 0.0;         ///< Energy still stored in it when it is left in restitution [J].
  /// Energy stored in it when it is left in compression [J].
  double until = std::numeric_limits<double>::infinity();
};

/// How an impact at a single point ends, in its axes.
struct SingleImpactEnd {
  Vec3 impulse = Vec3::Zero();   ///< [N s]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
};

/// Routh's solution: velocities followed along the growing normal impulse, friction against the
/// slip that is left at each of its values, sticking where friction can hold it, until the energy
/// of restitution is used up. (W. J. Stronge, Impact Mechanics, Cambridge University Press 2000,
/// chapters 3 to 5; V. Bhatt and J. Koechling, J. Appl. Mech. 62 (1995) 893-898.) @eq{routh}
[[nodiscard]] SingleImpactEnd end_of(const SingleImpact& impact);

}  // namespace polhode
