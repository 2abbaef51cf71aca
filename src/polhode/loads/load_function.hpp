// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <variant>

#include <polhode/core/types.hpp>

namespace polhode {

/// Motion of the point of a body at which a load acts, as code reads it: SI, world axes.
struct PointReading {
  double t = 0.0;                        ///< [s]; in statics the load factor.
  Vec3 position = Vec3::Zero();          ///< [m]
  Vec3 velocity = Vec3::Zero();          ///< [m/s]
  Quat orientation = Quat::Identity();   ///< Of the body, from its axes to the world's.
  Vec3 angular_velocity = Vec3::Zero();  ///< Of the body [rad/s].
};

/// Derivatives of a vector by a PointReading.
struct PointDerivative {
  Mat3 position = Mat3::Zero();          ///< [1/m]
  Mat3 velocity = Mat3::Zero();          ///< [s/m]
  Mat3 turn = Mat3::Zero();              ///< By a small rotation of the body, world axes [1/rad].
  Mat3 angular_velocity = Mat3::Zero();  ///< [s/rad]
};

/// A force [N] or moment [N m] on a body that code gives as a function of the body's motion. It is
/// a function of what it is given and nothing else: iterations, tangents and the ledger call it as
/// often as they like. What it throws ends the step and is passed on.
struct PointFunction {
  std::function<Vec3(const PointReading&)> value;
  /// Left empty, derivatives are taken by differences: six more calls an iteration.
  std::function<PointDerivative(const PointReading&)> derivative;
  bool reads_velocity = true;  ///< May dissipate, so that orders above 2 are refused.
};

/// A free coordinate of a joint, or the distance of two points, as code reads it.
struct CoordinateReading {
  double t = 0.0;      ///< [s]; in statics the load factor.
  double value = 0.0;  ///< Angle, turns counted [rad], displacement or distance [m].
  double rate = 0.0;   ///< [rad/s] or [m/s]
};

struct CoordinateDerivative {
  double value = 0.0, rate = 0.0;
};

/// A force [N] or moment [N m] along a coordinate that code gives as a function of it and its rate;
/// see PointFunction. Differences take two more calls an iteration.
struct CoordinateFunction {
  std::function<double(const CoordinateReading&)> value;
  std::function<CoordinateDerivative(const CoordinateReading&)> derivative;
  bool reads_velocity = true;
};

/// What code gives of a load, if anything.
using LoadFunction = std::variant<std::monostate, PointFunction, CoordinateFunction>;

/// Axes in which functions of a part count when the part stands elsewhere in a whole.
struct PartAxes {
  Vec3 origin = Vec3::Zero();         ///< Of the part, in the world [m].
  Mat3 axes = Mat3::Identity();       ///< From the part's axes to the world's; may mirror.
  Mat3 body_axes = Mat3::Identity();  ///< From the axes of its bodies to those they have here.
  double sense = 1.0;                 ///< −1: a coordinate counts the other way in the part.

  [[nodiscard]] bool is_world() const;
  /// These, placed once more by `outer`.
  [[nodiscard]] PartAxes within(const PartAxes& outer) const;
  /// From a vector of the part, in its axes or in those of a body, to one of the whole.
  /// @param axial  A moment: its mirror image is reversed.
  [[nodiscard]] Mat3 vector_map(bool body_fixed, bool axial) const;
};

/// The function as the whole sees it.
[[nodiscard]] LoadFunction placed(const LoadFunction& function, const PartAxes& part,
                                  bool body_fixed, bool axial);

}  // namespace polhode
