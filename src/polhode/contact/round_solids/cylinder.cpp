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

/// Smallest semi-axis of the disc, as a part of the radius.
constexpr double kThinnest = 1e-9;

/// A needle plus a disc, which have the extents of the core of a cylinder together.
struct NeedleAndDisc {
  Vec3 disc, needle;  ///< Semi-axes [m].

  /// @param e  Half thickness of the needle, as a part of its length.
  NeedleAndDisc(const geometry::Shape& s, double e, double end) {
    const double R = s.half[0], H = s.half[2], d = std::min(end, 0.5 * H / R);
    // h + r d = H along the axis and r + h e = R across it.
    const double h = (H - d * R) / (1.0 - d * e), r = std::max(kThinnest * R, R - h * e);
    disc = {r, r, r * d};
    needle = {h * e, h * e, h};
  }
};

/// Functions of RoundSolid.
template <bool flat>
struct Cylinder {
  static geometry::Shape shape(std::string_view where, std::span<const double> sizes,
                               const geometry::ShapePlace& place, double /*rounding*/) {
    return cylinder(where, sizes[0], sizes[1], place);
  }

  template <class T>
  static Gap<T> over(const V3<T>& x, double rho_a, const geometry::Shape& b,
                     const Placement<T>& at_b) {
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
  static V3<T> support(const geometry::Shape& s, const V3<T>* axes, const V3<T>& n, double blur) {
    const NeedleAndDisc sum(s, blur, end(blur));
    return of_ellipsoid(sum.disc, axes, n) + of_ellipsoid(sum.needle, axes, n) + s.rounding * n;
  }

  static CurvedSupport curved_support(const geometry::Shape& s, const Vec3& n, double blur) {
    const NeedleAndDisc sum(s, blur, end(blur));
    const CurvedSupport disc = curved_ellipsoid(sum.disc, n),
                        needle = curved_ellipsoid(sum.needle, n);
    return {disc.x + needle.x + s.rounding * n,
            disc.D + needle.D + s.rounding * (Mat3::Identity() - n * n.transpose())};
  }

  /// The point on the needle depends on the ratio of the components along and across the axis, over
  /// the blur, and that on the disc on the inverse.
  static Vec3 sharpened(const geometry::Shape& /*s*/, const Vec3& n, double from, double to) {
    const double across = std::hypot(n.x(), n.y()), along = std::abs(n.z());
    if (along <= kFar * from * across) return {n.x(), n.y(), to / from * n.z()};
    if (!flat || across > kFar * end(from) * along) return n;
    const double part = end(to) / end(from);
    return {part * n.x(), part * n.y(), n.z()};
  }

 private:
  /// Half thickness of the disc, as a part of its radius.
  static double end(double blur) { return bulge_of_end(flat, blur); }
};

}  // namespace

geometry::Shape cylinder(std::string_view where, double diameter, double length,
                         const geometry::ShapePlace& place) {
  geometry::check_positive(where, "diameter", diameter);
  geometry::check_positive(where, "length", length);
  const double rounding = 0.5 * geometry::kRounding * std::min(diameter, length);
  const double radius = 0.5 * diameter - rounding;
  geometry::Shape s =
      round_shape(cylinder_solid(), {radius, radius, 0.5 * length - rounding}, place);
  s.rounding = rounding;
  s.detail = 0.5 * std::min(diameter, length);
  add_flat_end(s, -s.half[2], radius);
  add_flat_end(s, s.half[2], radius);
  geometry::set_bounds(s, s.centre, std::hypot(radius, s.half[2]) + rounding);
  return s;
}

const RoundSolid& cylinder_solid() {
  static constexpr RoundSolid with_flat_ends = record_of<Cylinder<true>>("cylinder");
  static constexpr RoundSolid solid = record_of<Cylinder<false>>("cylinder", &with_flat_ends);
  return solid;
}

}  // namespace polhode::contact
