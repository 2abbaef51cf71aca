// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include <polhode/dynamics/body_step.hpp>
#include <polhode/math/dual.hpp>

namespace polhode::contact {

/// Placement of a body at an instant: maps body coordinates (from its centre of mass) to the world.
/// With T = Dual the results have derivatives by the body's increments.
template <class T>
class Placement {
 public:
  /// @param first  Index of the body's Δr_x among the directions of Dual: 0 for a, 6 for b.
  Placement(const Vec3& r, const Mat3& Lambda, int first)
      : r_(r), Lambda_(&Lambda), first_(first) {}

  /// Placement at the end of a step, relative to a point near the contact. Points are computed from
  /// their initial positions and displacements, so that the rounding of world positions does not
  /// affect gaps: deep in the barrier it would matter. @eq{contact-gap-change}
  Placement(const BodyStep& step, const Vec3& from, int first)
      : r_(step.r_n - from + step.u),
        Lambda_(&step.Lambda_n1),
        first_(first),
        step_(&step),
        start_(step.r_n - from) {}

  /// Λ Z: the body-fixed vector Z.
  [[nodiscard]] V3<T> vector(const Vec3& Z) const {
    const Vec3 z = *Lambda_ * Z;
    if constexpr (kFine)
      if (step_) return constant<T>(z_n(Z)) + turned(z_n(Z), z);
    V3<T> result = constant<T>(z);
    turn(result, z);
    return result;
  }
  /// Λ (Q − P), equal from both sides of an edge.
  [[nodiscard]] V3<T> between(const Vec3& P, const Vec3& Q) const {
    if constexpr (kFine) return vector(Q) - vector(P);
    return vector(Q - P);
  }
  /// r + Λ Z: the body-fixed point Z.
  [[nodiscard]] V3<T> point(const Vec3& Z) const {
    const Vec3 z = *Lambda_ * Z;
    V3<T> result = step_ ? at_end(Z, z) : constant<T>(r_ + z);
    turn(result, z);
    move(result);
    return result;
  }
  [[nodiscard]] V3<T> position() const {
    V3<T> result = kFine && step_ ? constant<T>(start_) + constant<T>(step_->u) : constant<T>(r_);
    move(result);
    return result;
  }
  /// Body coordinates of a world point, to find the nearest feature.
  [[nodiscard]] Vec3 to_body(const Vec3& x) const { return Lambda_->transpose() * (x - r_); }

 private:
  static constexpr bool kFine = std::is_same_v<T, Fine>;
  using Plain = std::conditional_t<kFine, Fine, double>;

  [[nodiscard]] Vec3 z_n(const Vec3& Z) const { return step_->Lambda_n * Z; }
  /// cay(θ) z_n − z_n = θ × z̄. With Fine from θ alone: the rotation at the end is rounded.
  [[nodiscard]] V3<Plain> turned(const Vec3& z_n, const Vec3& z) const {
    const V3<Plain> theta = constant<Plain>(step_->theta);
    if constexpr (kFine) {
      const V3<Fine> half = Fine(0.5) * theta, across = cross(theta, constant<Fine>(z_n));
      return (Fine(1.0) / (Fine(1.0) + dot(half, half))) * (across + cross(half, across));
    }
    return 0.5 * cross(theta, constant<Plain>(z_n) + constant<Plain>(z));
  }
  /// r_n + z_n + u + θ × z̄
  [[nodiscard]] V3<T> at_end(const Vec3& Z, const Vec3& z) const {
    const Vec3 z_0 = z_n(Z);
    const V3<Plain> moved = constant<Plain>(step_->u) + turned(z_0, z);
    const V3<Plain> x = (constant<Plain>(start_) + constant<Plain>(z_0)) + moved;
    return {T(x.x), T(x.y), T(x.z)};
  }
  void turn(V3<T>& result, const Vec3& z) const {
    if constexpr (std::is_same_v<T, Dual>) {
      const int k = first_ + 3;  // e_j × z
      result.y.d[k] = -z.z(), result.z.d[k] = z.y();
      result.x.d[k + 1] = z.z(), result.z.d[k + 1] = -z.x();
      result.x.d[k + 2] = -z.y(), result.y.d[k + 2] = z.x();
    }
  }
  void move(V3<T>& result) const {
    if constexpr (std::is_same_v<T, Dual>) {
      result.x.d[first_] = result.y.d[first_ + 1] = result.z.d[first_ + 2] = 1.0;
    }
  }

  Vec3 r_;
  const Mat3* Lambda_;
  int first_;
  const BodyStep* step_ = nullptr;  ///< Of the end of a step.
  Vec3 start_ = Vec3::Zero();
};

/// Displacement u and Cayley vector θ of a body's step, with their derivatives.
template <class T>
struct Motion {
  V3<T> u, theta;

  Motion(const BodyStep& step, int first) : u(constant<T>(step.u)), theta(constant<T>(step.theta)) {
    if constexpr (std::is_same_v<T, Dual>) {
      u.x.d[first] = u.y.d[first + 1] = u.z.d[first + 2] = 1.0;
      const Mat3 D = cayley_tangent(step.theta).transpose();  // for a left increment
      for (int j = 0; j < 3; ++j) {
        theta.x.d[first + 3 + j] = D(0, j);
        theta.y.d[first + 3 + j] = D(1, j);
        theta.z.d[first + 3 + j] = D(2, j);
      }
    }
  }
};

}  // namespace polhode::contact
