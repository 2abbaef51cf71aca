// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/core/types.hpp>

namespace polhode {

/// Contact between two bodies.
struct ContactReport {
  double gap = 0.0;              ///< Smallest [m]; NaN if they are too far apart.
  double normal_force = 0.0;     ///< Sum of all points, over the last step [N].
  Vec3 force = Vec3::Zero();     ///< On the first body, friction included, world [N].
  Vec3 friction = Vec3::Zero();  ///< On the first body, world [N].
  /// Mean of the points, weighted by normal force [m]; zero if none.
  Vec3 point = Vec3::Zero();
  int points = 0;            ///< Points with contact force.
  int status = 0;            ///< 0 open, 1 sticks, 2 slips; of a sensor 1: overlap.
  double impulse = 0.0;      ///< Of the normal force since the start [N s].
  double energy_lost = 0.0;  ///< Since the start, by impacts and friction [J].
};

/// Energy losses since the start [J].
struct ContactLosses {
  double impacts = 0.0, friction = 0.0;
};

/// Start or end of a sensor's overlap in the step that ended at t.
struct SensorEvent {
  double t = 0.0;
  std::string sensor;
  bool began = false;
};

}  // namespace polhode
