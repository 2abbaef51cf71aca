// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <Eigen/LU>

#include <polhode/contact/gap_parts.hpp>

namespace polhode::contact {

namespace {

/// Radius to which the corners of two cylinders or cones are rounded against each other, part of
/// their size: their support functions are smooth then.
constexpr double kSmooth = 1e-2;

/// x = centre + Σ B²n/|Bn|, the support point of a sum of ellipsoids with semi-axes B along `axes`.
template <class T>
V3<T> of_ellipsoid(const Vec3& B, const V3<T>* axes, const T* n) {
  const T length =
      sqrt(B[0] * B[0] * (n[0] * n[0]) + B[1] * B[1] * (n[1] * n[1]) + B[2] * B[2] * (n[2] * n[2]));
  V3<T> x = constant<T>(Vec3::Zero());
  for (int i = 0; i < 3; ++i) x = x + (B[i] * B[i] * n[i] / length) * axes[i];
  return x;
}

/// Support point of a round solid, from its centre, in the unit direction n; smooth in n.
///
/// A cylinder is a needle plus a disc of the same extents, a cone the smooth maximum of its apex
/// and its base. @eq{contact-round-support}
template <class T>
V3<T> support(const Shape& s, const V3<T>* axes, const V3<T>& direction) {
  const T n[3] = {dot(axes[0], direction), dot(axes[1], direction), dot(axes[2], direction)};
  const double R = s.half[0] + s.rounding, H = s.half[2] + s.rounding;
  const double e = kSmooth, one = std::sqrt(1.0 + e * e);
  if (s.solid == Solid::ellipsoid)
    return of_ellipsoid<T>(s.half + Vec3::Constant(s.rounding), axes, n);
  // h one + r e = H along the axis and r one + h e = R across it.
  const double det = one * one - e * e, h = (one * H - e * R) / det, r = (one * R - e * H) / det;
  const V3<T> disc = of_ellipsoid<T>({r * one, r * one, r * e}, axes, n);
  const V3<T> needle = of_ellipsoid<T>({h * e, h * e, h * one}, axes, n);
  if (s.solid == Solid::cylinder) return disc + needle;
  const V3<T> apex = (H - e * R) * axes[2];
  const V3<T> base = of_ellipsoid<T>({R, R, e * R}, axes, n) - (H - e * R) * axes[2];
  const T more = dot(apex - base, direction);
  const double soft = e * R;
  const T root = sqrt(more * more + soft * soft);
  return 0.5 * (apex + base + (more / root) * (apex - base) + (soft * soft / root) * direction);
}

template <class T>
struct Axes {
  V3<T> axis[3];
  V3<T> centre;
  Axes(const Shape& s, const Placement<T>& at) : centre(at.point(s.centre)) {
    for (int i = 0; i < 3; ++i) axis[i] = at.vector(s.axes.col(i));
  }
};

/// Numbers only, from an Axes of any sort.
template <class T>
void take_values(const Axes<T>& from, V3<Dual>* to) {
  for (int i = 0; i < 3; ++i) to[i] = constant<Dual>(value(from.axis[i]));
}

/// Support point and its derivative by the direction.
struct Curved {
  Vec3 x;
  Mat3 D;
};
Curved curved_support(const Shape& s, const V3<Dual>* axes, const Vec3& n) {
  V3<Dual> direction = constant<Dual>(n);
  direction.x.d[0] = direction.y.d[1] = direction.z.d[2] = 1.0;
  const V3<Dual> x = support<Dual>(s, axes, direction);
  Curved c;
  c.x = value(x);
  for (int j = 0; j < 3; ++j) c.D.col(j) = Vec3(x.x.d[j], x.y.d[j], x.z.d[j]);
  return c;
}

/// Two unit vectors across n.
void tangents(const Vec3& n, Vec3& e, Vec3& f) {
  e = n.unitOrthogonal();
  f = n.cross(e);
}

/// The direction in which two round solids are farthest apart: the largest of
/// F(n) = n·(x_a(−n) − x_b(n)), by Newton on the unit sphere.
struct Separation {
  Vec3 n;
  Eigen::Matrix2d M;  ///< −D of the tangential part of x_a − x_b by the two tangential moves of n.
};

Separation separate(const Shape& a, const Shape& b, const V3<Dual>* axes_a, const V3<Dual>* axes_b,
                    const Vec3& between) {
  Separation s;
  s.n = between.squaredNorm() > 0.0 ? Vec3(between.normalized()) : Vec3::UnitZ();
  const auto offset = [&](const Vec3& n, Mat3* D) {
    const Curved on_a = curved_support(a, axes_a, -n), on_b = curved_support(b, axes_b, n);
    if (D) *D = on_a.D + on_b.D;
    return Vec3(between + on_a.x - on_b.x);
  };
  Mat3 D;
  Vec3 w = offset(s.n, &D);
  for (int k = 0; k < 200; ++k) {
    Vec3 e, f;
    tangents(s.n, e, f);
    const double F = s.n.dot(w), size = D.diagonal().sum() + std::abs(F);
    s.M << e.dot(D * e) + F, e.dot(D * f), f.dot(D * e), f.dot(D * f) + F;
    const Eigen::Vector2d slope(e.dot(w), f.dot(w));
    if (slope.norm() <= 1e-14 * size) break;
    const bool convex = s.M(0, 0) > 0.0 && s.M.determinant() > 0.0;
    Eigen::Vector2d move = convex ? Eigen::Vector2d(s.M.inverse() * slope) : slope / size;
    if (move.norm() > 0.5) move *= 0.5 / move.norm();
    bool better = false;
    for (int cut = 0; cut < 40 && !better; ++cut, move *= 0.5) {
      const Vec3 next = (s.n + move[0] * e + move[1] * f).normalized();
      Mat3 D_next;
      const Vec3 w_next = offset(next, &D_next);
      better = next.dot(w_next) > F || (move.norm() < 1e-6 && next.dot(w_next) >= F - 1e-15 * size);
      if (!better) continue;
      s.n = next, w = w_next, D = D_next;
    }
    if (!better) break;
  }
  return s;
}

}  // namespace

template <class T>
V3<T> extreme_point(const Shape& a, int which, const V3<T>& n, const Placement<T>& at_a) {
  const Axes<T> at(a, at_a);
  if (a.solid == Solid::ellipsoid) {
    const T components[3] = {-dot(at.axis[0], n), -dot(at.axis[1], n), -dot(at.axis[2], n)};
    return at.centre + of_ellipsoid<T>(a.half, at.axis, components);
  }
  const double height = which == 0 ? -a.half[2] : a.half[2];
  const T x = -dot(at.axis[0], n), y = -dot(at.axis[1], n);
  const T across = sqrt(x * x + y * y + 1e-24);
  return at.centre + height * at.axis[2] + (a.half[0] * x / across) * at.axis[0] +
         (a.half[0] * y / across) * at.axis[1];
}

template <class T>
Gap<T> round_over_edge(const Shape& a, const Shape& b, int edge, const Placement<T>& at_a,
                       const Placement<T>& at_b) {
  const Vec3 &P = b.corners[b.edges[edge].i], &Q = b.corners[b.edges[edge].j];
  const V3<T> p = at_b.point(P), v = at_b.between(P, Q);
  // In coordinates of body a, with one direction of Dual for the parameter.
  const Vec3 X = at_a.to_body(value(p)), V = at_a.to_body(value(p) + value(v)) - X;
  const Mat3 no_turn = Mat3::Identity();
  const Placement<Dual> still(Vec3::Zero(), no_turn, 0);
  const auto slope = [&](double t, double& curvature) {
    Dual along(t);
    along.d[11] = 1.0;
    const V3<Dual> x = constant<Dual>(X) + along * constant<Dual>(V);
    const Gap<Dual> g = point_over_solid(x, 0.0, a, still);
    const Dual s = dot(g.normal, constant<Dual>(V));
    curvature = s.d[11];
    return s.v;
  };
  double curvature = 0.0, low = 0.0, high = 1.0, t = 0.5;
  if (slope(0.0, curvature) >= 0.0) {
    t = high = 0.0;
  } else if (slope(1.0, curvature) <= 0.0) {
    t = low = 1.0;
  } else {
    for (int k = 0; k < 200; ++k) {
      const double s = slope(t, curvature);
      (s < 0.0 ? low : high) = t;
      double next = curvature > 0.0 ? t - s / curvature : -1.0;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (std::abs(next - t) < 1e-16 || high - low < 1e-16) break;
      t = next;
    }
  }
  T at(t);
  if (low < high && curvature > 0.0) {
    const Gap<T> g = point_over_solid(p + t * v, 0.0, a, at_a);
    const T rest = dot(g.normal, v);
    at = t - (1.0 / curvature) * (rest - value(rest));
  }
  Gap<T> g = point_over_solid(p + at * v, b.rounding, a, at_a);
  g.normal = -g.normal;
  return g;
}

template <class T>
Gap<T> round_over_round(const Shape& a, const Shape& b, const Placement<T>& at_a,
                        const Placement<T>& at_b) {
  const Axes<T> on_a(a, at_a), on_b(b, at_b);
  V3<Dual> axes_a[3], axes_b[3];
  take_values(on_a, axes_a);
  take_values(on_b, axes_b);
  const V3<T> between = on_a.centre - on_b.centre;
  const Separation s = separate(a, b, axes_a, axes_b, value(between));
  // n in T: one Newton step from the direction found in numbers.
  Vec3 e, f;
  tangents(s.n, e, f);
  const V3<T> n_0 = constant<T>(s.n);
  const V3<T> w_0 = between + support<T>(a, on_a.axis, -n_0) - support<T>(b, on_b.axis, n_0);
  const T r_e = dot(v3(e), w_0), r_f = dot(v3(f), w_0);
  const Eigen::Matrix2d inverse = s.M.inverse();
  const T d_e = inverse(0, 0) * r_e + inverse(0, 1) * r_f;
  const T d_f = inverse(1, 0) * r_e + inverse(1, 1) * r_f;
  const V3<T> n = unit(n_0 + d_e * v3(e) + d_f * v3(f));
  const V3<T> x = on_a.centre + support<T>(a, on_a.axis, -n);
  const V3<T> y = on_b.centre + support<T>(b, on_b.axis, n);
  Gap<T> g;
  g.normal = n;
  g.distance = dot(n, x - y);
  g.point = 0.5 * (x + y);
  return g;
}

template V3<double> extreme_point(const Shape&, int, const V3<double>&, const Placement<double>&);
template V3<Dual> extreme_point(const Shape&, int, const V3<Dual>&, const Placement<Dual>&);
template V3<Fine> extreme_point(const Shape&, int, const V3<Fine>&, const Placement<Fine>&);
template Gap<double> round_over_edge(const Shape&, const Shape&, int, const Placement<double>&,
                                     const Placement<double>&);
template Gap<Dual> round_over_edge(const Shape&, const Shape&, int, const Placement<Dual>&,
                                   const Placement<Dual>&);
template Gap<Fine> round_over_edge(const Shape&, const Shape&, int, const Placement<Fine>&,
                                   const Placement<Fine>&);
template Gap<double> round_over_round(const Shape&, const Shape&, const Placement<double>&,
                                      const Placement<double>&);
template Gap<Fine> round_over_round(const Shape&, const Shape&, const Placement<Fine>&,
                                    const Placement<Fine>&);
template Gap<Dual> round_over_round(const Shape&, const Shape&, const Placement<Dual>&,
                                    const Placement<Dual>&);

}  // namespace polhode::contact
