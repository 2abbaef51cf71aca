// SPDX-License-Identifier: Apache-2.0
#include <polhode/surface_contact/nearest_weights.hpp>
#include <polhode/surface_contact/round_friction.hpp>

namespace polhode::surface_contact {

namespace {

using contact::V3;

/// Two sides of a triangle and its normal, the frame of vectors that rotate with it.
template <class T>
struct Sides : SlidePlane<T> {
  V3<T> normal;
  T per;  ///< 1/|e × f|
  Sides(const V3<T>& one, const V3<T>& other) : SlidePlane<T>(one, other) {
    const V3<T> across = cross(one, other);
    per = 1.0 / norm(across);
    normal = per * across;
  }
  /// Vector with given components, scaled to `length`.
  [[nodiscard]] V3<T> along(const double (&parts)[3], double length) const {
    const V3<T> s = parts[0] * this->e + parts[1] * this->f + parts[2] * normal;
    return scaled(s, length);
  }
  [[nodiscard]] static V3<T> scaled(const V3<T>& s, double length) {
    const T square = dot(s, s);
    if (!(contact::value(square) > 0.0)) return 0.0 * s;
    return (length / sqrt(square)) * s;
  }
};

template <class T>
struct Sliding {
  V3<T> bristle, friction;
  bool slips = false;
  double parts[3]{};  ///< Of the bristle, see Sides.
};

template <class T>
struct RoundPoint {
  V3<T> force[4], slid;
  Sliding<T> sliding;
};

template <class T>
Sides<T> sides_at(const V3<T>& a, const V3<T>& b, const V3<T>& c) {
  return {b - a, c - a};
}

/// Slip relative to the triangle. ω is the triangle's rotation, exact for rigid rotations.
template <class T>
RoundPoint<T> round_point_friction(const FourMoves& moves, double alpha, const SurfaceLaw& law,
                                   const T& pressure, const Vec3& kept, bool seeded) {
  const FourPoints<T> at(moves, alpha, seeded);
  Vec3 middle[4];
  moves.at(alpha, middle);
  T c[4];
  nearest_weights(nearest_of_triangle(middle), at.x, c);
  const Sides<T> here = sides_at(at.x[1], at.x[2], at.x[3]);
  const V3<T> du_e = at.u[2] - at.u[1], du_f = at.u[3] - at.u[1];
  V3<T> y = c[0] * (at.x[0] - at.x[3]), way = c[0] * at.u[0];
  for (int k = 1; k < 4; ++k) {
    y = y + c[k] * (at.x[k] - at.x[3]);
    way = way + c[k] * at.u[k];
  }
  const V3<T> omega =
      here.per * (dot(here.normal, du_f) * here.e - dot(here.normal, du_e) * here.f +
                  (0.5 * (dot(here.f, du_e) - dot(here.e, du_f))) * here.normal);
  way = way - cross(omega, y);
  const V3<T> n = unit(y);
  RoundPoint<T> r;
  r.slid = way - dot(n, way) * n;
  const Sides<double> before =
      sides_at(contact::v3(at.x_n[1]), contact::v3(at.x_n[2]), contact::v3(at.x_n[3]));
  const V3<double> s = contact::v3(kept);
  const double components[3] = {dot(before.grad_e, s), dot(before.grad_f, s),
                                dot(before.normal, s)};
  V3<T> turned = here.along(components, kept.norm());
  turned = Sides<T>::scaled(turned - dot(n, turned) * n, kept.norm());
  contact::Cone<T> cone;
  cone.radius = (law.mu / law.bristle) * pressure;
  const V3<T> start = cone.nearest(turned);
  r.sliding.slips = cone.outside(contact::value(start + r.slid));
  r.sliding.bristle = cone.nearest(start + r.slid);
  r.sliding.friction = -law.bristle * cone.nearest(start + alpha * r.slid);
  const V3<T>& bristle = r.sliding.bristle;
  r.sliding.parts[0] = contact::value(dot(here.grad_e, bristle));
  r.sliding.parts[1] = contact::value(dot(here.grad_f, bristle));
  r.sliding.parts[2] = contact::value(dot(here.normal, bristle));
  const V3<T>& h = r.sliding.friction;
  const V3<T> moment = cross(y, h);
  const T on_n = dot(here.normal, moment);
  const V3<T> on_e = here.per * (dot(here.f, moment) * here.normal - (0.5 * on_n) * here.f);
  const V3<T> on_f = here.per * ((0.5 * on_n) * here.e - dot(here.e, moment) * here.normal);
  r.force[0] = c[0] * h;
  r.force[1] = c[1] * h - on_e - on_f;
  r.force[2] = c[2] * h + on_e;
  r.force[3] = c[3] * h + on_f;
  return r;
}

}  // namespace

FourSlide round_friction(const FourMoves& moves, double alpha, const SurfaceLaw& law,
                         double pressure, const Vec3& kept, bool tangent) {
  const auto sliding = [&](const auto& p, bool seeded) {
    return round_point_friction(moves, alpha, law, p, kept, seeded);
  };
  const auto& x = moves.x_n1;
  const Sides<double> end = sides_at(contact::v3(x[1]), contact::v3(x[2]), contact::v3(x[3]));
  return {sliding, end, pressure, tangent};
}

}  // namespace polhode::surface_contact
