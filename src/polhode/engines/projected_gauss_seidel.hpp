// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// Projected Gauss-Seidel solver for impulses at points between bodies.
///
/// Velocities are twice the mean ones of the step, y = 2 v̄: an impulse changes them by M⁻¹Jᵀp, and
/// dissipates the energy −½ p·y. The conditions of a point are y_n ≥ c_n, p_n ≥ 0, one of them an
/// equality, and y_t = c_t with p_t inside the cone. @eq{nonsmooth-projection}
class ProjectedGaussSeidel {
 public:
  struct Body {
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();  ///< Of the centre of mass; angular [m/s, rad/s].
    double inverse_mass = 0.0;                ///< 0: fixed [1/kg].
    Mat3 inverse_inertia = Mat3::Zero();      ///< World [1/(kg m²)].
  };
  /// Change of the impulse at a point by a projection.
  struct Change {
    Vec3 impulse = Vec3::Zero();  ///< [N s]
    double speed_squared = 0.0;   ///< Of the point, by that impulse [m²/s²].
    bool nothing = true;          ///< The point is and stays open.
  };
  struct Point {
    int a = 0, b = 0;                      ///< Bodies, including fixed ones.
    Vec3 normal, arm_a, arm_b;             ///< From b to a; from the centres of mass [-, m].
    double least = 0.0;                    ///< c_n [m/s].
    Vec3 wanted = Vec3::Zero();            ///< c_t, tangential [m/s].
    double friction = 0.0;                 ///< μ
    double normal_impulse = 0.0;           ///< p_n [N s].
    Vec3 friction_impulse = Vec3::Zero();  ///< p_t [N s].
    double per_normal = 0.0;               ///< D_nn: speed by impulse [1/kg].
    double per_friction = 0.0;             ///< Largest of D_tt [1/kg].
    Vec3 across = Vec3::Zero();            ///< D_tn: tangential speed by normal impulse [1/kg].
    double free_normal = 0.0, free_friction = 0.0;  ///< Inverses.

    /// Projects the impulse onto the friction cone. @param y  Relative velocity there [m/s].
    Change projected(const Vec3& y);
  };
  /// Rolling and torsional friction at a point.
  struct Turn {
    int point = 0;
    double rolling = 0.0, torsion = 0.0;  ///< Moments over the normal impulse [m].
    Vec3 wanted = Vec3::Zero();           ///< Target of the relative angular velocity [rad/s].
    Vec3 impulse = Vec3::Zero();          ///< [N m s]
    double per_impulse = 0.0;             ///< [1/(kg m²)]
    double length = 0.0;                  ///< Length that makes angular speeds comparable [m].
  };

  std::vector<Body> bodies;
  std::vector<Point> points;
  std::vector<Turn> turns;

  /// Computes what depends on lever arms and bodies.
  void prepare();
  void prepare(Point& p);  ///< Likewise of one of the points.
  /// One sweep over all points, in order or from the last to the first.
  /// @returns the largest change of a point's speed, squared [m²/s²].
  double sweep(bool backwards);
  /// Applies an impulse at a point, and an angular impulse.
  void apply(const Point& p, const Vec3& impulse);
  void turn(const Point& p, const Vec3& impulse);

 private:
  double sweep_turns();
};

}  // namespace polhode
