// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <variant>

#include <polhode/core/types.hpp>

namespace polhode {

/// Motion of the point of a body at which a load acts, input of functions in code: SI, world axes.
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

/// A force [N] or moment [N m] on a body given in code as a function of the body's motion. It must
/// depend on its arguments alone: iterations, tangents and the ledger call it any number of times.
/// An exception ends the step and is passed on.
struct PointFunction {
  std::function<Vec3(const PointReading&)> value;
  /// If empty, derivatives are taken by differences: six more calls per iteration.
  std::function<PointDerivative(const PointReading&)> derivative;
  bool reads_velocity = true;  ///< May dissipate, so that orders above 2 are rejected.
};

/// A free coordinate of a joint, or the distance of two points, input of functions in code.
struct CoordinateReading {
  double t = 0.0;      ///< [s]; in statics the load factor.
  double value = 0.0;  ///< Angle with counted turns [rad], displacement or distance [m].
  double rate = 0.0;   ///< [rad/s] or [m/s]
};

struct CoordinateDerivative {
  double value = 0.0, rate = 0.0;
};

/// A force [N] or moment [N m] along a coordinate given in code as a function of it and its rate;
/// see PointFunction. Differences need two more calls per iteration.
struct CoordinateFunction {
  std::function<double(const CoordinateReading&)> value;
  std::function<CoordinateDerivative(const CoordinateReading&)> derivative;
  bool reads_velocity = true;
};

/// Function of a load given in code, if any.
using LoadFunction = std::variant<std::monostate, PointFunction, CoordinateFunction>;

/// Axes for functions of a part that is placed in a whole.
struct PartAxes {
  Vec3 origin = Vec3::Zero();         ///< Of the part, in the world [m].
  Mat3 axes = Mat3::Identity();       ///< From the part's axes to the world's; may be a reflection.
  Mat3 body_axes = Mat3::Identity();  ///< From the axes of its bodies to their axes in the whole.
  double sense = 1.0;                 ///< −1: a coordinate has the opposite sense in the part.

  [[nodiscard]] bool is_world() const;
  /// These axes, placed once more by `outer`.
  [[nodiscard]] PartAxes within(const PartAxes& outer) const;
  /// Map of a vector of the part, in its axes or in those of a body, to one of the whole.
  /// @param axial  A moment: its mirror image is reversed.
  [[nodiscard]] Mat3 vector_map(bool body_fixed, bool axial) const;
};

/// The function in terms of the whole.
[[nodiscard]] LoadFunction placed(const LoadFunction& function, const PartAxes& part,
                                  bool body_fixed, bool axial);

}  // namespace polhode
