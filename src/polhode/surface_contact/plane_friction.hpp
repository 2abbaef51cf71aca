// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include <polhode/contact_laws/bristle.hpp>
#include <polhode/surface_contact/central_gap.hpp>
#include <polhode/surface_contact/surface_law.hpp>

namespace polhode::surface_contact {

/// Two directions that span the sliding plane, such as two sides of a triangle, and their dual
/// vectors: grad_e·e = 1, grad_e·f = 0.
template <class T>
struct SlidePlane {
  contact::V3<T> e, f, grad_e, grad_f;
  SlidePlane(const contact::V3<T>& one, const contact::V3<T>& other) : e(one), f(other) {
    const T ee = dot(e, e), ef = dot(e, f), ff = dot(f, f);
    const T scale = 1.0 / (ee * ff - ef * ef);
    grad_e = scale * (ff * e - ef * f);
    grad_f = scale * (ee * f - ef * e);
  }
  /// Vector with given components along e and f, scaled to `length`.
  [[nodiscard]] contact::V3<T> along(double on_e, double on_f, double length) const {
    const contact::V3<T> s = on_e * e + on_f * f;
    const T square = dot(s, s);
    if (!(contact::value(square) > 0.0)) return 0.0 * s;
    return (length / sqrt(square)) * s;
  }
  [[nodiscard]] contact::V3<T> along(const double (&parts)[2], double length) const {
    return along(parts[0], parts[1], length);
  }
};

/// Four points in scalar type T: positions at the middle of a step and displacements.
template <class T>
struct FourPoints {
  contact::V3<T> x[4], u[4];
  Vec3 x_n[4];

  /// @param seeded  With derivatives by x_{n+1}.
  FourPoints(const FourMoves& moves, double alpha, bool seeded) {
    for (int k = 0; k < 4; ++k) {
      x[k] = contact::constant<T>(moves.x_n1[k] - (1.0 - alpha) * moves.u[k]);
      u[k] = contact::constant<T>(moves.u[k]);
      x_n[k] = moves.x_n1[k] - moves.u[k];
      if constexpr (std::is_same_v<T, contact::Dual>)
        if (seeded) {
          u[k].x.d[3 * k] = u[k].y.d[3 * k + 1] = u[k].z.d[3 * k + 2] = 1.0;
          x[k] = x[k] + alpha * (u[k] - contact::v3(moves.u[k]));
        }
    }
  }
};

/// A friction bristle in a plane over a step, per area. @eq{contact-bristle}
template <class T>
struct PlaneSliding {
  contact::V3<T> bristle, friction;
  bool slips = false;
  double parts[2]{};  ///< Components of the bristle along the plane's directions.

  /// @param kept  The bristle at t_n, in the plane `before` of t_n; it rotates with the directions
  /// and keeps its length.
  PlaneSliding(const SlidePlane<T>& here, const SlidePlane<double>& before, const SurfaceLaw& law,
               const T& pressure, const Vec3& kept, const contact::V3<T>& slid, double alpha) {
    const contact::V3<double> s = contact::v3(kept);
    contact::Cone<T> cone;
    cone.radius = (law.mu / law.bristle) * pressure;
    const contact::V3<T> start =
        cone.nearest(here.along(dot(before.grad_e, s), dot(before.grad_f, s), kept.norm()));
    slips = cone.outside(contact::value(start + slid));
    bristle = cone.nearest(start + slid);
    friction = -law.bristle * cone.nearest(start + alpha * slid);
    parts[0] = contact::value(dot(here.grad_e, bristle));
    parts[1] = contact::value(dot(here.grad_f, bristle));
  }
};

/// Friction between four points over a step, per area.
struct FourSlide {
  Vec3 friction = Vec3::Zero();    ///< On the sliding side.
  Vec3 slid = Vec3::Zero();        ///< Tangential displacement.
  Vec3 bristle = Vec3::Zero();     ///< In the middle of the step.
  Vec3 bristle_n1 = Vec3::Zero();  ///< In the axes of its end.
  bool slips = false;
  Eigen::Matrix<double, 12, 1> force = Eigen::Matrix<double, 12, 1>::Zero();  ///< On the four.
  Eigen::Matrix<double, 12, 12> K = Eigen::Matrix<double, 12, 12>::Zero();    ///< By x_{n+1}.
  Eigen::Matrix<double, 12, 1> by_pressure = Eigen::Matrix<double, 12, 1>::Zero();

  /// @param sliding  (pressure in scalar type T, seeded) → an object with force[4], slid and a
  /// PlaneSliding `sliding`, all of type T.
  /// @param end  The plane or other frame of bristles at t_{n+1}.
  template <class Sliding, class End>
  FourSlide(Sliding&& sliding, const End& end, double pressure, bool tangent) {
    const auto values = sliding(pressure, false);
    friction = contact::value(values.sliding.friction);
    slid = contact::value(values.slid);
    bristle = contact::value(values.sliding.bristle);
    slips = values.sliding.slips;
    bristle_n1 = contact::value(end.along(values.sliding.parts, bristle.norm()));
    for (int k = 0; k < 4; ++k) force.segment<3>(3 * k) = contact::value(values.force[k]);
    if (!tangent) return;
    const auto by_x = sliding(contact::Dual(pressure), true);
    contact::Dual seed(pressure);
    seed.d[0] = 1.0;
    const auto by_p = sliding(seed, false);
    for (int k = 0; k < 4; ++k) {
      const contact::V3<contact::Dual>&f = by_x.force[k], &g = by_p.force[k];
      for (int j = 0; j < 12; ++j) K.block<3, 1>(3 * k, j) << f.x.d[j], f.y.d[j], f.z.d[j];
      by_pressure.segment<3>(3 * k) << g.x.d[0], g.y.d[0], g.z.d[0];
    }
  }
  FourSlide() = default;
};

}  // namespace polhode::surface_contact
