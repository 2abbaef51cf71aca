// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

/// Value and slope of a curve of a muscle.
struct CurveValue {
  double value = 0.0, slope = 0.0;
};

// Dimensionless curves of De Groote, Kinney, Rao, Fregly, Evaluation of direct collocation optimal
// control problem formulations for solving the muscle redundancy problem, Annals of Biomedical
// Engineering 44 (2016) 2922-2936, with constants rounded so that the force-velocity curve is 1 at
// rest and 0 at full speed of shortening. Lengths over the optimal fibre length, velocities over
// the largest speed of shortening, forces over the largest isometric force.

/// Force of a fully active fibre at rest over its length. @eq{muscle-length}
[[nodiscard]] CurveValue active_force_length(double length);
/// Force of a fibre that is not active. @eq{muscle-passive}
[[nodiscard]] CurveValue passive_force_length(double length);
/// Integral of the passive force from length 0 [-].
[[nodiscard]] double passive_energy(double length);
/// Part of the isometric force that an active fibre has over its velocity, negative while it
/// shortens. @eq{muscle-velocity}
[[nodiscard]] CurveValue force_velocity(double velocity);

}  // namespace polhode
