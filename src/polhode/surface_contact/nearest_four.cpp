// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/geometry/nearest.hpp>
#include <polhode/surface_contact/nearest_four.hpp>

namespace polhode::surface_contact {

namespace {

/// Squared sine of the angle between edges below which they have no unique nearest points.
constexpr double kParallelEdges = 1e-8;

void measure(const Vec3 (&x)[4], NearestFour& n) {
  Vec3 y = Vec3::Zero();
  // Relative to the last point, to avoid rounding far from the origin.
  for (int i = 0; i < 3; ++i) y += n.c[i] * (x[i] - x[3]);
  n.distance = y.norm();
}

}  // namespace

/// @eq{four-point-distance}
NearestFour::Lengths NearestFour::gradient() const {
  Lengths g;
  for (int l = 0; l < kLengths; ++l) g[l] = -c[kEnds[l][0]] * c[kEnds[l][1]];
  return g;
}

/// Hessian of |y|². Where c is free, Zᵀ S c = 0 with S_ij = s_ij and Z the free directions: so Zᵀ S
/// Z δη = −Zᵀ δS c.
Eigen::Matrix<double, NearestFour::kLengths, NearestFour::kLengths> NearestFour::hessian(
    const Vec3 (&x)[4]) const {
  Eigen::Matrix<double, kLengths, kLengths> H = Eigen::Matrix<double, kLengths, kLengths>::Zero();
  if (free_count == 0) return H;
  // zᵀ S z' = −2 (Σ z x)·(Σ z' x) for directions that sum to zero.
  Vec3 way[2];
  for (int k = 0; k < free_count; ++k) {
    way[k].setZero();
    for (int i = 0; i < 3; ++i) way[k] += free[k][i] * (x[i] - x[3]);
  }
  Eigen::Matrix<double, 2, kLengths> by_length = Eigen::Matrix<double, 2, kLengths>::Zero();
  for (int l = 0; l < kLengths; ++l) {
    const int i = kEnds[l][0], j = kEnds[l][1];
    for (int k = 0; k < free_count; ++k) by_length(k, l) = free[k][i] * c[j] + free[k][j] * c[i];
  }
  Eigen::Matrix2d M = Eigen::Matrix2d::Identity();
  for (int k = 0; k < free_count; ++k)
    for (int m = 0; m < free_count; ++m) M(k, m) = 2.0 * way[k].dot(way[m]);
  const Eigen::Matrix<double, 2, kLengths> eta = M.inverse() * by_length;
  for (int l = 0; l < kLengths; ++l) {
    const int i = kEnds[l][0], j = kEnds[l][1];
    for (int k = 0; k < free_count; ++k)
      H.row(l) -= (free[k][i] * c[j] + free[k][j] * c[i]) * eta.row(k);
  }
  return H;
}

NearestFour nearest_of_triangle(const Vec3 (&x)[4]) {
  const geometry::TriangleRegion region = geometry::nearest_on_triangle(x[0], x[1], x[2], x[3]);
  NearestFour n;
  n.c[0] = 1.0;
  if (region.kind == geometry::TriangleRegion::corner) {
    n.c[1 + region.k] = -1.0;
  } else if (region.kind == geometry::TriangleRegion::edge) {
    const int a = 1 + region.k, b = 1 + (region.k + 1) % 3;
    const Vec3 e = x[b] - x[a];
    const double t = (region.nearest - x[a]).dot(e) / e.squaredNorm();
    n.c[a] = t - 1.0;
    n.c[b] = -t;
    n.free[0][a] = 1.0;
    n.free[0][b] = -1.0;
    n.free_count = 1;
  } else {
    const Vec3 e = x[2] - x[1], f = x[3] - x[1], p = x[0] - x[1];
    const double ee = e.squaredNorm(), ef = e.dot(f), ff = f.squaredNorm();
    const double scale = 1.0 / (ee * ff - ef * ef);
    const double u = scale * (ff * e.dot(p) - ef * f.dot(p));
    const double v = scale * (ee * f.dot(p) - ef * e.dot(p));
    n.c << 1.0, u + v - 1.0, -u, -v;
    n.free[0] << 0.0, 1.0, -1.0, 0.0;
    n.free[1] << 0.0, 1.0, 0.0, -1.0;
    n.free_count = 2;
  }
  measure(x, n);
  return n;
}

NearestFour nearest_of_corner(const Vec3 (&x)[4], int a) {
  NearestFour n;
  n.c[0] = 1.0;
  n.c[a] = -1.0;
  measure(x, n);
  return n;
}

NearestFour nearest_of_edge(const Vec3 (&x)[4], int a, int b) {
  const Vec3 e = x[b] - x[a];
  const double t = (x[0] - x[a]).dot(e) / e.squaredNorm();
  if (!(t > 0.0 && t < 1.0)) return nearest_of_corner(x, t > 0.0 ? b : a);
  NearestFour n;
  n.c[0] = 1.0;
  n.c[a] = t - 1.0;
  n.c[b] = -t;
  n.free[0][a] = 1.0;
  n.free[0][b] = -1.0;
  n.free_count = 1;
  measure(x, n);
  return n;
}

NearestFour nearest_of_edges(const Vec3 (&x)[4], double e_place, double f_place) {
  const Vec3 e = x[1] - x[0], f = x[3] - x[2];
  double a = e_place, b = f_place;
  bool a_free = false, b_free = false;
  // Position on an edge of squared length l, from `from` along `to`, that is nearest to p.
  const auto project = [](const Vec3& p, const Vec3& from, const Vec3& along, double& part) {
    const double t = (p - from).dot(along) / along.squaredNorm();
    part = std::clamp(t, 0.0, 1.0);
    return part == t;
  };
  // Ends are returned exactly.
  const auto on = [](const Vec3& from, const Vec3& to, double part) -> Vec3 {
    if (part == 0.0) return from;
    return part == 1.0 ? to : Vec3((1.0 - part) * from + part * to);
  };
  if (e_place < 0.0 && f_place < 0.0) {
    const geometry::SegmentsRegion r = geometry::nearest_on_segments(x[0], e, x[2], f);
    a = r.s, b = r.t;
    a_free = r.s_free, b_free = r.t_free;
    if (a_free && b_free)
      a_free = e.cross(f).squaredNorm() > kParallelEdges * e.squaredNorm() * f.squaredNorm();
  } else if (e_place < 0.0) {
    a_free = project(on(x[2], x[3], f_place), x[0], e, a);
  } else if (f_place < 0.0) {
    b_free = project(on(x[0], x[1], e_place), x[2], f, b);
  }
  NearestFour n;
  n.c << 1.0 - a, a, b - 1.0, -b;
  if (a_free) n.free[n.free_count++] << 1.0, -1.0, 0.0, 0.0;
  if (b_free) n.free[n.free_count++] << 0.0, 0.0, 1.0, -1.0;
  measure(x, n);
  return n;
}

}  // namespace polhode::surface_contact
