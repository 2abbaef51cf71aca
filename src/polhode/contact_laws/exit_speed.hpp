// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode::contact {

/// Smallest normal speed of a point at the end of a step [m/s]; negative: it still approaches.
/// Twice the mean speed of the step never exceeds what energy allows. @eq{nonsmooth-exit}
/// @param gap  At t_n [m].
/// @param w  Normal speed at t_n, negative: approaching [m/s].
/// @param dt  Step [s].
/// @param slow  Slower rebounds are suppressed [m/s].
[[nodiscard]] double least_exit_speed(double gap, double w, double restitution, double dt,
                                      double slow);

}  // namespace polhode::contact
