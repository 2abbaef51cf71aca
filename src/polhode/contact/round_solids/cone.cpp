// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/round_solids/cone.hpp>
#include <polhode/contact/round_solids/meridian.hpp>
#include <polhode/contact/round_solids/round_shape.hpp>
#include <polhode/geometry/shape_checks.hpp>

namespace polhode::contact {

namespace {

/// Smooth maximum of the supports of the apex and of the base, a flat ellipsoid.
struct ApexAndBase {
  Vec3 base;        ///< Semi-axes [m].
  double apex;      ///< Distance from the centre to the apex, and also to the base [m].
  double softness;  ///< Where apex and base are equally far [m].

  explicit ApexAndBase(const Shape& s) {
    const double R = s.half[0] + s.rounding, H = s.half[2] + s.rounding, e = blur::coarse;
    base = {R, R, e * R};
    apex = H - e * R;
    softness = e * R;
  }
};

/// Functions of RoundSolid.
struct Cone {
  static Shape shape(std::string_view where, std::span<const double> sizes, const ShapePlace& place,
                     double rounding) {
    // The centroid is a quarter of the length above the base.
    const ShapePlace middle{place.origin + 0.25 * sizes[1] * place.axes.col(2), place.axes};
    return cone(where, sizes[0], sizes[1], middle, rounding);
  }

  template <class T>
  static Gap<T> over(const V3<T>& x, double rho_a, const Shape& b, const Placement<T>& at_b) {
    const Meridian<T> m(x, b, at_b);
    const double R = b.half[0], H = b.half[2], h = value(m.h), q = value(m.q);
    const double slant = std::hypot(R, 2.0 * H), n_q = 2.0 * H / slant, n_h = R / slant;
    const double along = ((q - R) * -R + (h + H) * 2.0 * H) / slant;  // from the rim to the apex
    const double above = (q - R) * n_q + (h + H) * n_h;               // over the flank
    const double below = -H - h;                                      // under the base
    const auto flank = [&] {
      return over_plane(x, m.point(at_b, b, -H, R), n_q * m.outward + n_h * m.axis, rho_a,
                        b.rounding);
    };
    const auto base = [&] {
      return over_plane(x, m.point(at_b, b, -H, 0.0), -m.axis, rho_a, b.rounding);
    };
    if (above <= 0.0 && below <= 0.0) return above > below ? flank() : base();
    if (above > 0.0 && along >= 0.0) {
      if (along < slant) return flank();
      return between_points(x, at_b.point(b.centre + H * b.axes.col(2)), rho_a, b.rounding);
    }
    if (q <= R) return base();
    return between_points(x, m.point(at_b, b, -H, R), rho_a, b.rounding);
  }

  /// @eq{contact-round-support}
  template <class T>
  static V3<T> support(const Shape& s, const V3<T>* axes, const V3<T>& n, double /*blur*/) {
    const ApexAndBase parts(s);
    const V3<T> apex = parts.apex * axes[2], base = of_ellipsoid(parts.base, axes, n) - apex,
                d = apex - base;
    const double soft = parts.softness * parts.softness;
    const T more = dot(d, n), root = sqrt(more * more + soft);
    return 0.5 * (apex + base + (more / root) * d + (soft / root) * n);
  }

  static CurvedSupport curved_support(const Shape& s, const Vec3& n, double /*blur*/) {
    const ApexAndBase parts(s);
    CurvedSupport c = curved_ellipsoid(parts.base, n);
    const Vec3 apex = parts.apex * Vec3::UnitZ(), base = c.x - apex, d = apex - base;
    const double more = d.dot(n), soft = parts.softness * parts.softness;
    const double root = std::sqrt(more * more + soft);
    c.x = 0.5 * (apex + base + (more / root) * d + (soft / root) * n);
    c.D = 0.5 * ((1.0 - more / root) * c.D + (soft / root) * Mat3::Identity() +
                 (soft / (root * root * root)) * (d - more * n) * d.transpose());
    return c;
  }

  static Vec3 sharpened(const Shape& /*s*/, const Vec3& n, double /*from*/, double /*to*/) {
    return n;
  }
};

}  // namespace

Shape cone(std::string_view where, double diameter, double length, const ShapePlace& place,
           double rounding) {
  check_positive(where, "diameter", diameter);
  check_positive(where, "length", length);
  const double radius = 0.5 * diameter;
  check_rounding(where, rounding, 0.25 * std::min(radius, length));
  if (rounding == 0.0) rounding = 0.5 * kRounding * std::min(radius, length);
  // Cone whose base and lateral surface are offset inward by the rounding.
  const double above_base = rounding, below_apex = rounding * std::hypot(radius, length) / radius;
  const double core_length = length - above_base - below_apex;
  const double core_radius = radius * core_length / length;
  Shape s = round_shape(cone_solid(), {core_radius, core_radius, 0.5 * core_length}, place);
  s.chords.head<2>() *= 0.5;
  s.centre += 0.5 * (above_base - below_apex) * s.axes.col(2);
  s.rounding = rounding;
  s.detail = 0.5 * std::min(radius, length);
  add_flat_end(s, -s.half[2], core_radius);
  s.points.push_back(static_cast<int>(s.corners.size()));
  s.face_points.push_back(s.points.back());
  s.corners.push_back(s.centre + s.half[2] * s.axes.col(2));
  set_bounds(s, s.centre, std::hypot(radius, 0.5 * length) + below_apex);
  return s;
}

const RoundSolid& cone_solid() {
  static constexpr RoundSolid solid = record_of<Cone>("cone");
  return solid;
}

}  // namespace polhode::contact
