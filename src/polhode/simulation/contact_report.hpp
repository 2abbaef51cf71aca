// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/core/types.hpp>

namespace polhode {

/// What two bodies do to each other.
struct ContactReport {
  double gap = 0.0;              ///< Smallest [m]; NaN while they are too far apart to know.
  double normal_force = 0.0;     ///< Sum of all points, over the last step [N].
  Vec3 force = Vec3::Zero();     ///< On the first body, friction included, world [N].
  Vec3 friction = Vec3::Zero();  ///< On the first body, world [N].
  Vec3 point = Vec3::Zero();     ///< Mean of the points, by normal force [m]; zero if none.
  int points = 0;                ///< That carry force.
  int status = 0;                ///< 0 open, 1 sticks, 2 slips; of a sensor 1 overlaps.
  double impulse = 0.0;          ///< Of the normal force since the start [N s].
  double energy_lost = 0.0;      ///< Since the start, in impacts and by friction [J].
};

/// Where energy went since the start [J].
struct ContactLosses {
  double impacts = 0.0, friction = 0.0;
};

/// A sensor's bodies began or ceased to overlap in the step that ended at t.
struct SensorEvent {
  double t = 0.0;
  std::string sensor;
  bool began = false;
};

}  // namespace polhode
