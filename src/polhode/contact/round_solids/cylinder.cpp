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

/// Ratio over the blur beyond which the support point is near an end of the side, or the rim.
constexpr double kFar = 30.0;

/// A needle plus a disc, which have the extents of the core of a cylinder together.
struct NeedleAndDisc {
  Vec3 disc, needle;  ///< Semi-axes [m].

  NeedleAndDisc(const Shape& s, double e) {
    const double R = s.half[0], H = s.half[2];
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
  static V3<T> support(const Shape& s, const V3<T>* axes, const V3<T>& n, double blur) {
    const NeedleAndDisc sum(s, blur);
    return of_ellipsoid(sum.disc, axes, n) + of_ellipsoid(sum.needle, axes, n) + s.rounding * n;
  }

  static CurvedSupport curved_support(const Shape& s, const Vec3& n, double blur) {
    const NeedleAndDisc sum(s, blur);
    const CurvedSupport disc = curved_ellipsoid(sum.disc, n),
                        needle = curved_ellipsoid(sum.needle, n);
    return {disc.x + needle.x + s.rounding * n,
            disc.D + needle.D + s.rounding * (Mat3::Identity() - n * n.transpose())};
  }

  /// The support point depends on the ratio of the components along and across the axis, over the
  /// blur where the former is the smaller one, times the blur where it is the larger one.
  static Vec3 sharpened(const Shape& /*s*/, const Vec3& n, double from, double to) {
    const double across = std::hypot(n.x(), n.y()), along = std::abs(n.z());
    const double ratio = std::min(across, along) / std::max(across, along);
    if (ratio > kFar * from) return n;
    return along < across ? Vec3(n.x(), n.y(), to / from * n.z())
                          : Vec3(to / from * n.x(), to / from * n.y(), n.z());
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
