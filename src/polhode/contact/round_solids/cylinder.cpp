// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/round_solids/cylinder.hpp>
#include <polhode/contact/round_solids/meridian.hpp>
#include <polhode/contact/round_solids/round_shape.hpp>
#include <polhode/geometry/shape_checks.hpp>

namespace polhode::contact {

namespace {

/// A needle plus a disc, which have the extents of the cylinder together.
struct NeedleAndDisc {
  Vec3 disc, needle;  ///< Semi-axes [m].

  explicit NeedleAndDisc(const Shape& s) {
    const double R = s.half[0] + s.rounding, H = s.half[2] + s.rounding, e = kSmooth;
    // h one + r e = H along the axis and r one + h e = R across it.
    const double one = std::sqrt(1.0 + e * e), h = one * H - e * R, r = one * R - e * H;
    disc = {r * one, r * one, r * e};
    needle = {h * e, h * e, h * one};
  }
};

/// Functions of RoundSolid.
struct Cylinder {
  static Shape shape(std::string_view where, std::span<const double> sizes, const ShapePlace& place,
                     double /*rounding*/) {
    return cylinder(where, sizes[0], sizes[1], place);
  }

  template <class T>
  static Gap<T> over(const V3<T>& x, double rho_a, const Shape& b, const Placement<T>& at_b) {
    const Meridian<T> m(x, b, at_b);
    const double R = b.half[0], H = b.half[2], h = value(m.h), q = value(m.q);
    const double side = h < 0.0 ? -1.0 : 1.0;
    const bool beside = q > R, beyond = std::abs(h) > H;
    if (beside && beyond)
      return between_points(x, m.point(at_b, b, side * H, R), rho_a, b.rounding);
    if (beside || (!beyond && R - q < H - std::abs(h)))
      return over_plane(x, m.point(at_b, b, 0.0, R), m.outward, rho_a, b.rounding);
    return over_plane(x, m.point(at_b, b, side * H, 0.0), side * m.axis, rho_a, b.rounding);
  }

  /// @eq{contact-round-support}
  template <class T>
  static V3<T> support(const Shape& s, const V3<T>* axes, const V3<T>& n) {
    const NeedleAndDisc sum(s);
    return of_ellipsoid(sum.disc, axes, n) + of_ellipsoid(sum.needle, axes, n);
  }

  static CurvedSupport curved_support(const Shape& s, const Vec3& n) {
    const NeedleAndDisc sum(s);
    const CurvedSupport disc = curved_ellipsoid(sum.disc, n),
                        needle = curved_ellipsoid(sum.needle, n);
    return {disc.x + needle.x, disc.D + needle.D};
  }
};

}  // namespace

Shape cylinder(std::string_view where, double diameter, double length, const ShapePlace& place) {
  check_positive(where, "diameter", diameter);
  check_positive(where, "length", length);
  const double rounding = 0.5 * kRounding * std::min(diameter, length);
  const double radius = 0.5 * diameter - rounding;
  Shape s = round_shape(cylinder_solid(), {radius, radius, 0.5 * length - rounding}, place);
  s.rounding = rounding;
  s.detail = 0.5 * std::min(diameter, length);
  add_flat_end(s, -s.half[2], radius);
  add_flat_end(s, s.half[2], radius);
  set_bounds(s, s.centre, std::hypot(radius, s.half[2]) + rounding);
  return s;
}

const RoundSolid& cylinder_solid() {
  static constexpr RoundSolid solid = record_of<Cylinder>("cylinder");
  return solid;
}

}  // namespace polhode::contact
