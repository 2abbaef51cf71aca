// SPDX-License-Identifier: Apache-2.0
// Geodesics of ellipsoids and cylinders by Taylor series.
#include <algorithm>
#include <array>
#include <cmath>

#include <polhode/geometry/wrapping.hpp>

namespace polhode::geometry {

namespace {

/// Degree of the series.
constexpr int kDegree = 20;
/// Part of the size that the last terms of a series may have.
constexpr double kLastTerm = 1e-17;

using Series = std::array<double, kDegree + 1>;

/// Coefficient k of a product.
double product(const Series& a, const Series& b, int k) {
  double sum = 0.0;
  for (int i = 0; i <= k; ++i) sum += a[i] * b[k - i];
  return sum;
}

/// Coefficient k of the quotient c = a/b, whose earlier ones are known.
double quotient(double a_k, const Series& b, const Series& c, int k) {
  double sum = a_k;
  for (int i = 0; i < k; ++i) sum -= c[i] * b[k - i];
  return sum / b[0];
}

double value(const Series& a, double h) {
  double sum = 0.0;
  for (int k = kDegree; k >= 0; --k) sum = sum * h + a[k];
  return sum;
}

/// 1/a² of each axis.
Vec3 quadric(const Roller& roller) { return roller.semi_axes.cwiseAbs2().cwiseInverse(); }

}  // namespace

/// With D the matrix of the quadric, xᵀDx = 1, and y = Dx: x'' = −(x'ᵀDx'/yᵀy) y, and Jacobi fields
/// j'' = −K j with Gauss's curvature K = det D/(yᵀy)². @eq{wrap-geodesic}
GeodesicEnd follow_geodesic(const Roller& roller, const Vec3& from, const Vec3& along,
                            double length) {
  const Vec3 D = quadric(roller);
  const double det = D.prod(), scale = kLastTerm * roller.size();
  GeodesicEnd e{.x = from, .t = along};
  std::array<Series, 3> x, v, y;
  Series w, s, q, squared, K, a, da, r, dr;
  for (double rest = length; rest > 0.0;) {
    a[0] = e.across, da[0] = e.across_rate, r[0] = e.turned, dr[0] = e.turned_rate;
    for (int i = 0; i < 3; ++i) x[i][0] = e.x[i], v[i][0] = e.t[i], y[i][0] = D[i] * e.x[i];
    for (int k = 0; k < kDegree; ++k) {
      w[k] = s[k] = 0.0;
      for (int i = 0; i < 3; ++i) {
        w[k] += D[i] * product(v[i], v[i], k);
        s[k] += product(y[i], y[i], k);
      }
      q[k] = quotient(w[k], s, q, k);
      squared[k] = product(s, s, k);
      K[k] = quotient(k == 0 ? det : 0.0, squared, K, k);
      const double next = 1.0 / (k + 1);
      for (int i = 0; i < 3; ++i) {
        x[i][k + 1] = next * v[i][k];
        v[i][k + 1] = -next * product(q, y[i], k);
        y[i][k + 1] = D[i] * x[i][k + 1];
      }
      a[k + 1] = next * da[k], da[k + 1] = -next * product(K, a, k);
      r[k + 1] = next * dr[k], dr[k + 1] = -next * product(K, r, k);
    }
    double h = rest;
    for (const int k : {kDegree - 1, kDegree}) {
      const double last = std::hypot(x[0][k], x[1][k], x[2][k]);
      if (last > 0.0) h = std::min(h, std::pow(scale / last, 1.0 / k));
    }
    for (int i = 0; i < 3; ++i) e.x[i] = value(x[i], h), e.t[i] = value(v[i], h);
    e.across = value(a, h), e.across_rate = value(da, h);
    e.turned = value(r, h), e.turned_rate = value(dr, h);
    rest = h < rest ? rest - h : 0.0;
  }
  return e;
}

}  // namespace polhode::geometry
