// SPDX-License-Identifier: Apache-2.0
#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/round_solids/ellipsoid.hpp>
#include <polhode/contact/round_solids/round_shape.hpp>
#include <polhode/geometry/nearest.hpp>
#include <polhode/geometry/shape_checks.hpp>

namespace polhode::contact {

namespace {

/// Functions of RoundSolid.
struct Ellipsoid {
  static geometry::Shape shape(std::string_view where, std::span<const double> sizes,
                               const geometry::ShapePlace& place, double /*rounding*/) {
    return ellipsoid(where, {sizes[0], sizes[1], sizes[2]}, place);
  }

  /// Root with derivatives, by one Newton step in T from the root found in plain numbers.
  template <class T>
  static Gap<T> over(const V3<T>& x, double rho_a, const geometry::Shape& b,
                     const Placement<T>& at_b) {
    const V3<T> w = x - at_b.point(b.centre);
    V3<T> axis[3];
    T y[3];
    Vec3 Y;
    for (int i = 0; i < 3; ++i) {
      axis[i] = at_b.vector(b.axes.col(i));
      y[i] = dot(axis[i], w);
      Y[i] = value(y[i]);
    }
    T t(geometry::nearest_on_ellipsoid(b.half, Y));
    // At the middle of the shortest axis the root is double: a step might leave on the wrong side.
    const double shortest = b.half.minCoeff();
    const bool double_root = value(t) < -(1.0 - 1e-6) * shortest * shortest;
    for (int step = double_root ? 2 : 0; step < (std::is_same_v<T, Fine> ? 2 : 1); ++step) {
      T f(-1.0);
      double slope = 0.0;
      for (int i = 0; i < 3; ++i) {
        const T d = b.half[i] * b.half[i] + t;
        const T part = b.half[i] * y[i] / d;
        f = f + part * part;
        slope -= 2.0 * value(part) * value(part) / value(d);
      }
      t = t - (1.0 / slope) * f;
    }
    V3<T> normal = constant<T>(Vec3::Zero()), nearest = at_b.point(b.centre);
    for (int i = 0; i < 3; ++i) {
      const double square = b.half[i] * b.half[i];
      const T share = y[i] / (t + square);
      normal = normal + share * axis[i];
      nearest = nearest + (square * share) * axis[i];
    }
    return over_plane(x, nearest, unit(normal), rho_a, b.rounding);
  }

  template <class T>
  static V3<T> support(const geometry::Shape& s, const V3<T>* axes, const V3<T>& n, double blur) {
    return of_ellipsoid(thickened(s, blur), axes, n);
  }

  static CurvedSupport curved_support(const geometry::Shape& s, const Vec3& n, double blur) {
    return curved_ellipsoid(thickened(s, blur), n);
  }

  static Vec3 sharpened(const geometry::Shape& s, const Vec3& n, double from, double to) {
    return n.cwiseProduct(thickened(s, from).cwiseQuotient(thickened(s, to)).cwiseAbs2());
  }

 private:
  static Vec3 thickened(const geometry::Shape& s, double blur) {
    const Vec3 half = s.half + Vec3::Constant(s.rounding);
    return half.cwiseMax(blur * half.maxCoeff());
  }
};

}  // namespace

geometry::Shape ellipsoid(std::string_view where, const Vec3& size,
                          const geometry::ShapePlace& place) {
  for (int i = 0; i < 3; ++i) geometry::check_positive(where, "size", size[i]);
  const double rounding = 0.5 * geometry::kRounding * size.minCoeff();
  geometry::Shape s = round_shape(ellipsoid_solid(), 0.5 * size - Vec3::Constant(rounding), place);
  s.rounding = rounding;
  s.detail = 0.5 * size.minCoeff();
  geometry::set_bounds(s, place.origin, 0.5 * size.maxCoeff());
  return s;
}

const RoundSolid& ellipsoid_solid() {
  static constexpr RoundSolid solid = record_of<Ellipsoid>("ellipsoid");
  return solid;
}

}  // namespace polhode::contact
