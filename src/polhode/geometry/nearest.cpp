// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/geometry/nearest.hpp>

namespace polhode::geometry {

namespace {

/// Relative size of root-finding steps below which they are rounding.
constexpr double kRootDigits = 1e-15;
/// Rounding error of a sum of three squares that is 1.
constexpr double kRound = 4.5e-16;

}  // namespace

/// Nearest region by the Voronoi regions of a triangle, see Ericson, Real-Time Collision Detection,
/// 5.1.5. On the boundary of regions the face is preferred.
TriangleRegion nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d_1 = ab.dot(ap), d_2 = ac.dot(ap), d_3 = ab.dot(bp), d_4 = ac.dot(bp);
  const double d_5 = ab.dot(cp), d_6 = ac.dot(cp);
  const double u = d_3 * d_6 - d_5 * d_4, v = d_5 * d_2 - d_1 * d_6, w = d_1 * d_4 - d_3 * d_2;
  const double slack = -1e-12 * (u + v + w);
  if (u >= slack && v >= slack && w >= slack) {
    const double sum = u + v + w;
    return {TriangleRegion::face, 0, (u * a + v * b + w * c) / sum};
  }
  if (d_1 <= 0.0 && d_2 <= 0.0) return {TriangleRegion::corner, 0, a};
  if (d_3 >= 0.0 && d_4 <= d_3) return {TriangleRegion::corner, 1, b};
  if (d_6 >= 0.0 && d_5 <= d_6) return {TriangleRegion::corner, 2, c};
  if (w <= 0.0 && d_1 >= 0.0 && d_3 <= 0.0)
    return {TriangleRegion::edge, 0, a + d_1 / (d_1 - d_3) * ab};
  if (v <= 0.0 && d_2 >= 0.0 && d_6 <= 0.0)
    return {TriangleRegion::edge, 2, a + d_2 / (d_2 - d_6) * ac};
  const double along = (d_4 - d_3) / ((d_4 - d_3) + (d_5 - d_6));
  return {TriangleRegion::edge, 1, b + along * (c - b)};
}

PolyhedronRegion nearest_on_polyhedron(const Shape& shape, const Vec3& p) {
  PolyhedronRegion best;
  double least = std::numeric_limits<double>::infinity(), deepest = -least;
  bool outside = false;
  for (int t = 0; t < static_cast<int>(shape.planes.size()); ++t) {
    const double height = shape.planes[t].normal.dot(p) - shape.planes[t].offset;
    if (height <= 0.0) {
      if (!outside && height > deepest) {
        deepest = height;
        best = {t, {TriangleRegion::face, 0, p - height * shape.planes[t].normal}, true};
      }
      continue;
    }
    outside = true;
    if (height * height >= least) continue;
    const auto& c = shape.triangles[t];
    const TriangleRegion r =
        nearest_on_triangle(p, shape.corners[c[0]], shape.corners[c[1]], shape.corners[c[2]]);
    const double squared = (p - r.nearest).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    best = {t, r, false};
  }
  return best;
}

/// Nearest points of two segments, see Ericson, Real-Time Collision Detection, 5.1.9.
SegmentsRegion nearest_on_segments(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
  SegmentsRegion r;
  const Vec3 w = p - q;
  const double a = u.squaredNorm(), b = u.dot(v), e = v.squaredNorm();
  const double c = u.dot(w), f = v.dot(w), denominator = a * e - b * b;
  const double s = denominator > 1e-10 * a * e ? (b * f - c * e) / denominator : 0.5;
  r.s = std::clamp(s, 0.0, 1.0);
  r.s_free = r.s == s;
  const double t = (b * r.s + f) / e;
  r.t = std::clamp(t, 0.0, 1.0);
  r.t_free = r.t == t;
  if (r.t_free) return r;
  const double again = (b * r.t - c) / a;
  r.s = std::clamp(again, 0.0, 1.0);
  r.s_free = r.s == again;
  return r;
}

/// Root of Σ (aᵢ yᵢ/(aᵢ² + t))² = 1, t > −min a²: Newton's method for the square root of that sum,
/// whose inverse is nearly linear in t, safeguarded by bisection.
double nearest_on_ellipsoid(const Vec3& half, const Vec3& y) {
  const double a_min = half.minCoeff(), a_max = half.maxCoeff();
  const auto sum = [&](double t, double& slope) {
    double squares = 0.0;
    slope = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double d = half[i] * half[i] + t, x = half[i] * y[i] / d;
      squares += x * x;
      slope -= 2.0 * x * x / d;
    }
    return squares;
  };
  double low = -a_min * a_min * (1.0 - 1e-9), high = a_max * y.norm() + 1e-300;
  // No term of the sum is above 1 at the root, from which Newton's method starts below it.
  double t = std::max(low, (half.cwiseProduct(y.cwiseAbs()) - half.cwiseAbs2()).maxCoeff());
  for (int k = 0; k < 100; ++k) {
    double slope = 0.0;
    const double squares = sum(t, slope);
    if (std::abs(squares - 1.0) <= kRound) return t;
    (squares > 1.0 ? low : high) = t;
    double next = 0.5 * (low + high);
    if (slope < 0.0) next = t - 2.0 * squares * (std::sqrt(squares) - 1.0) / slope;
    // Before the safeguard: at the root rounding moves the next iterate out of the bracket.
    if (std::abs(next - t) <= kRootDigits * (a_min * a_min + std::abs(t))) return next;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    t = next;
  }
  return t;
}

}  // namespace polhode::geometry
