// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/core/types.hpp>

namespace polhode {

/// An impact at a single point, in axes along its normal and two tangents.
struct SingleImpact {
  Mat3 mobility;             ///< K: velocity of the point by a unit impulse [1/kg]; symmetric.
  Vec3 velocity;             ///< Approach velocity: its normal part is negative [m/s].
  double mu = 0.0;           ///< Coefficient of friction along the first tangent.
  double mu_across = 0.0;    ///< Along the second one.
  double restitution = 0.0;  ///< e: e² of the work of compression is returned (Stronge).
  double stored = 0.0;       ///< Energy stored in the point when the impact starts [J].
  double kept = 0.0;         ///< Energy still stored when it ends in restitution [J].
  /// Energy stored when it ends in compression [J].
  double until = std::numeric_limits<double>::infinity();
};

/// End of an impact at a single point, in its axes.
struct SingleImpactEnd {
  Vec3 impulse = Vec3::Zero();   ///< [N s]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
};

/// Routh's solution: velocities are followed along the increasing normal impulse, with friction
/// against the current slip, or sticking where friction can hold it, until the energy of
/// restitution is used up. (W. J. Stronge, Impact Mechanics, Cambridge University Press 2000,
/// chapters 3 to 5; V. Bhatt and J. Koechling, J. Appl. Mech. 62 (1995) 893-898.) @eq{routh}
[[nodiscard]] SingleImpactEnd end_of(const SingleImpact& impact);

}  // namespace polhode
