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

/// Half thickness of the rim seen from above, as a part of the radius.
constexpr double kThin = 1e-9;

/// Smooth maximum of the supports of the apex and of the base, a disc whose rim lies on the flank
/// and which bulges down to the end.
struct ApexAndBase {
  double R, H;      ///< Radius at the end and half length [m].
  double bulge;     ///< [m]
  double radius;    ///< Of the disc [m].
  double height;    ///< Of the disc, along the axis from the centre [m].
  double softness;  ///< Where apex and base are equally far [m].

  ApexAndBase(const geometry::Shape& s, double blur, double end) : R(s.half[0]), H(s.half[2]) {
    bulge = end * std::min(R, H);
    radius = R * (1.0 - bulge / (2.0 * H));
    height = bulge - H;
    softness = blur * R;
  }
  /// Semi-axes of the disc as seen along a direction with this component along the axis.
  [[nodiscard]] Vec3 disc(double along) const {
    return {radius, radius, along < 0.0 ? bulge : kThin * R};
  }
};

/// Functions of RoundSolid.
template <bool flat>
struct Cone {
  static geometry::Shape shape(std::string_view where, std::span<const double> sizes,
                               const geometry::ShapePlace& place, double rounding) {
    // The centroid is a quarter of the length above the base.
    const geometry::ShapePlace middle{place.origin + 0.25 * sizes[1] * place.axes.col(2),
                                      place.axes};
    return cone(where, sizes[0], sizes[1], middle, rounding);
  }

  template <class T>
  static Gap<T> over(const V3<T>& x, double rho_a, const geometry::Shape& b,
                     const Placement<T>& at_b) {
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
  static V3<T> support(const geometry::Shape& s, const V3<T>* axes, const V3<T>& n, double blur) {
    const ApexAndBase parts(s, blur, end(blur));
    const V3<T> apex = parts.H * axes[2],
                base = parts.height * axes[2] +
                       of_ellipsoid(parts.disc(value(dot(axes[2], n))), axes, n),
                d = apex - base;
    const double soft = parts.softness * parts.softness;
    const T more = dot(d, n), root = sqrt(more * more + soft);
    return 0.5 * (apex + base + (more / root) * d + (soft / root) * n) + s.rounding * n;
  }

  static CurvedSupport curved_support(const geometry::Shape& s, const Vec3& n, double blur) {
    const ApexAndBase parts(s, blur, end(blur));
    CurvedSupport c = curved_ellipsoid(parts.disc(n.z()), n);
    const Vec3 apex = parts.H * Vec3::UnitZ(), base = c.x + parts.height * Vec3::UnitZ(),
               d = apex - base;
    const double more = d.dot(n), soft = parts.softness * parts.softness;
    const double root = std::sqrt(more * more + soft);
    c.x = 0.5 * (apex + base + (more / root) * d + (soft / root) * n) + s.rounding * n;
    c.D = 0.5 * ((1.0 - more / root) * c.D + (soft / root) * Mat3::Identity() +
                 (soft / (root * root * root)) * (d - more * n) * d.transpose()) +
          s.rounding * (Mat3::Identity() - n * n.transpose());
    return c;
  }

  /// The point on the flank depends on the ratio of the components along and across it, over the
  /// blur, and that on a flat end on that of those across and along the axis, over the bulge.
  static Vec3 sharpened(const geometry::Shape& s, const Vec3& n, double from, double to) {
    const double R = s.half[0], length = 2.0 * s.half[2], slant = std::hypot(R, length);
    const double q = std::hypot(n.x(), n.y());
    const double across = (q * length + n.z() * R) / slant,
                 along = (n.z() * length - q * R) / slant;
    if (q > 0.0 && slant * std::abs(along) <= kFar * from * R * across) {
      const double less = to / from * along, part = (across * length - less * R) / (slant * q);
      return {part * n.x(), part * n.y(), (across * R + less * length) / slant};
    }
    if (!flat || n.z() > 0.0 || q > kFar * end(from) * -n.z()) return n;
    const double part = end(to) / end(from);
    return {part * n.x(), part * n.y(), n.z()};
  }

 private:
  static double end(double blur) { return bulge_of_end(flat, blur); }
};

}  // namespace

geometry::Shape cone(std::string_view where, double diameter, double length,
                     const geometry::ShapePlace& place, double rounding) {
  geometry::check_positive(where, "diameter", diameter);
  geometry::check_positive(where, "length", length);
  const double radius = 0.5 * diameter;
  geometry::check_rounding(where, rounding, 0.25 * std::min(radius, length));
  if (rounding == 0.0) rounding = 0.5 * geometry::kRounding * std::min(radius, length);
  // Cone whose base and lateral surface are offset inward by the rounding.
  const double above_base = rounding, below_apex = rounding * std::hypot(radius, length) / radius;
  const double core_length = length - above_base - below_apex;
  const double core_radius = radius * core_length / length;
  geometry::Shape s =
      round_shape(cone_solid(), {core_radius, core_radius, 0.5 * core_length}, place);
  s.chords.head<2>() *= 0.5;
  s.centre += 0.5 * (above_base - below_apex) * s.axes.col(2);
  s.rounding = rounding;
  s.detail = 0.5 * std::min(radius, length);
  add_flat_end(s, -s.half[2], core_radius);
  s.points.push_back(static_cast<int>(s.corners.size()));
  s.face_points.push_back(s.points.back());
  s.corners.push_back(s.centre + s.half[2] * s.axes.col(2));
  geometry::set_bounds(s, s.centre, std::hypot(radius, 0.5 * length) + below_apex);
  return s;
}

const RoundSolid& cone_solid() {
  static constexpr RoundSolid with_flat_end = record_of<Cone<true>>("cone");
  static constexpr RoundSolid solid = record_of<Cone<false>>("cone", &with_flat_end);
  return solid;
}

}  // namespace polhode::contact
