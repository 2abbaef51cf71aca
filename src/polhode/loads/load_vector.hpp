// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// Force or moment of a load on body b over a step: functions of time, and a function of the motion
/// given in code, with components in the world or rotating with the body. Taken at t_{n+αf}: the
/// arguments of the function are the mean point and velocities of the step and the mean
/// orientation. @eq{callable-force}
class LoadVector {
 public:
  using Mat3x6 = Eigen::Matrix<double, 3, 6>;
  struct OverStep {
    Vec3 value;                    ///< World.
    Mat3x6 by_b = Mat3x6::Zero();  ///< By the increment (Δr, Δθ) of b.
  };

  explicit LoadVector(const LoadDescription& load);

  /// @param Z  Point of the function, from the centre of mass, body axes [m].
  [[nodiscard]] OverStep over_step(const PairStep& step, const Vec3& Z) const;
  /// The value alone.
  [[nodiscard]] Vec3 value(const PairStep& step, const Vec3& Z) const;
  /// Value at an instant, in full even in statics with a load factor.
  [[nodiscard]] Vec3 at_instant(const PairStep& step, const Vec3& Z) const;
  /// Whether it is a constant vector of the world, which at a point has a potential.
  [[nodiscard]] bool is_dead() const { return dead_; }
  [[nodiscard]] bool reads_velocity() const { return function_ && function_->reads_velocity; }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const {
    return {vector_.begin(), vector_.end()};
  }

 private:
  void add_function(const PairStep& step, const Vec3& Z, OverStep& s) const;

  TimeVector vector_;
  std::optional<PointFunction> function_;
  bool body_fixed_, dead_;
  /// Radius of gyration of b [m]; 0 for point masses: the scale of small displacements.
  double length_;
};

/// Arguments of a function over a step at the point Z of a body.
[[nodiscard]] PointReading point_reading(const StepContext& context, const BodyStep& body,
                                         const Vec3& Z);

/// Value of a function of a coordinate over a step, with its derivatives.
struct CoordinateValue {
  double value = 0.0, by_value = 0.0, by_rate = 0.0;
};
/// @param tangents  Computes derivatives; by differences if the function has none.
[[nodiscard]] CoordinateValue coordinate_value(const CoordinateFunction& f,
                                               const CoordinateReading& at, bool tangents);

}  // namespace polhode
