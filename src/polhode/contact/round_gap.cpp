// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/round_solids/ellipsoid.hpp>
#include <polhode/contact/round_solids/round_shape.hpp>

namespace polhode::contact {

namespace {

/// Support point of a round solid, from its centre, in the unit direction n.
template <class T>
V3<T> support(const Shape& s, const V3<T>* axes, const V3<T>& n) {
  return s.round_solid->formulas<T>().support(s, axes, n);
}

/// Support point of a shape in the world.
template <class T>
struct Axes {
  V3<T> axis[3];
  V3<T> centre;
  Axes(const Shape& s, const Placement<T>& at) : centre(at.point(s.centre)) {
    for (int i = 0; i < 3; ++i) axis[i] = at.vector(s.axes.col(i));
  }
};

template <class T>
Mat3 values(const Axes<T>& axes) {
  Mat3 columns;
  for (int i = 0; i < 3; ++i) columns.col(i) = value(axes.axis[i]);
  return columns;
}

/// Like `support`, in the world, with its derivative by the direction.
CurvedSupport curved_support(const Shape& s, const Mat3& axes, const Vec3& direction) {
  const CurvedSupport c = s.round_solid->curved_support(s, axes.transpose() * direction);
  return {axes * c.x, axes * c.D * axes.transpose()};
}

/// Largest half thickness of a needle, as a part of its length.
constexpr double kSlender = 1e-3;

/// An edge as a slender ellipsoid. Unlike a straight line it has a unique nearest point to a face
/// that it lies on. The rounding of the edge beyond its thickness is left out.
Shape needle(const Shape& b, int edge) {
  const Vec3 &p = b.corners[b.edges[edge].i], &q = b.corners[b.edges[edge].j];
  Shape s;
  const double length = (q - p).norm(), thickness = std::min(b.rounding, kSlender * length);
  s.solid = Solid::round;
  s.round_solid = &ellipsoid_solid();
  s.centre = 0.5 * (p + q);
  s.half = {0.5 * length, thickness, thickness};
  s.axes.col(0) = (q - p).normalized();
  s.axes.col(1) = s.axes.col(0).unitOrthogonal();
  s.axes.col(2) = s.axes.col(0).cross(s.axes.col(1));
  return s;
}

/// Two unit vectors normal to n.
void tangents(const Vec3& n, Vec3& e, Vec3& f) {
  e = n.unitOrthogonal();
  f = n.cross(e);
}

/// Direction of largest separation of two round solids: the maximum of F(n) = n·(x_a(−n) − x_b(n)),
/// by Newton's method on the unit sphere.
struct Separation {
  Vec3 n;
  Eigen::Matrix2d M;  ///< Negative derivative of the tangential part of x_a − x_b by the two
                      ///< tangential increments of n.
};

/// @param between  From the centre of b to that of a.
/// @param start  Initial direction, of any length.
Separation separate(const Shape& a, const Shape& b, const Mat3& axes_a, const Mat3& axes_b,
                    const Vec3& between, const Vec3& start) {
  Separation s;
  s.n = start.squaredNorm() > 0.0 ? Vec3(start.normalized()) : Vec3::UnitZ();
  const auto offset = [&](const Vec3& n, Mat3* D) {
    const CurvedSupport on_a = curved_support(a, axes_a, -n), on_b = curved_support(b, axes_b, n);
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
    // Where F is not concave, each principal direction ascends by its own curvature.
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal;
    principal.computeDirect(s.M);
    const Eigen::Vector2d curvature = principal.eigenvalues().cwiseAbs().cwiseMax(1e-12 * size);
    Eigen::Vector2d move = principal.eigenvectors() *
                           (principal.eigenvectors().transpose() * slope).cwiseQuotient(curvature);
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

/// @param start  Approximate direction from b to a.
/// @param rounding  Of b, beyond its own.
template <class T>
Gap<T> smooth_gap(const Shape& a, const Shape& b, const Placement<T>& at_a,
                  const Placement<T>& at_b, const Vec3& start, double rounding = 0.0) {
  const Axes<T> on_a(a, at_a), on_b(b, at_b);
  const V3<T> between = on_a.centre - on_b.centre;
  const Separation s = separate(a, b, values(on_a), values(on_b), value(between), start);
  // n in T: one Newton step from the direction found in plain numbers.
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
  g.distance = dot(n, x - y) - rounding;
  g.point = 0.5 * (x + y + rounding * n);
  return g;
}

}  // namespace

template <class T>
V3<T> extreme_point(const Shape& a, int which, const V3<T>& n, const Placement<T>& at_a) {
  const Axes<T> at(a, at_a);
  if (a.flat_ends.empty()) {
    const T components[3] = {-dot(at.axis[0], n), -dot(at.axis[1], n), -dot(at.axis[2], n)};
    return at.centre + of_ellipsoid<T>(a.half, at.axis, components);
  }
  const auto& [height, radius] = a.flat_ends[static_cast<std::size_t>(which)];
  const T x = -dot(at.axis[0], n), y = -dot(at.axis[1], n);
  const T across = sqrt(x * x + y * y + 1e-24);
  return at.centre + height * at.axis[2] + (radius * x / across) * at.axis[0] +
         (radius * y / across) * at.axis[1];
}

template <class T>
Gap<T> round_over_edge(const Shape& a, const Shape& b, int edge, const Placement<T>& at_a,
                       const Placement<T>& at_b) {
  const Shape slender = needle(b, edge);
  // As if a were a ball: the nearest point of the needle is that of the edge.
  const Vec3 X = at_b.to_body(value(at_a.point(a.centre))) - slender.centre,
             v = slender.axes.col(0);
  const double along = v.dot(X), length = slender.half.x(), part = along / length;
  Vec3 start = X - along * v;
  const double left = 1.0 - part * part;
  if (left > 1e-6)
    start = start.normalized() + (part / std::sqrt(left) * slender.half.y() / length) * v;
  else
    start += (along - std::copysign(length, along)) * v;
  return smooth_gap(a, slender, at_a, at_b, value(at_b.vector(start)),
                    b.rounding - slender.half.y());
}

template <class T>
Gap<T> round_over_round(const Shape& a, const Shape& b, const Placement<T>& at_a,
                        const Placement<T>& at_b) {
  return smooth_gap(a, b, at_a, at_b, value(at_a.point(a.centre)) - value(at_b.point(b.centre)));
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
