// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include <polhode/core/format.hpp>
#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::test {

inline void write_obj(const std::string& file, const geometry::TriangleSurface& surface) {
  std::ofstream out(file);
  for (const Vec3& x : surface.points)
    out << format("v {:.17g} {:.17g} {:.17g}\n", x[0], x[1], x[2]);
  for (const auto& t : surface.triangles)
    out << format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
}

/// A box about the origin with n × n × 1 cells.
inline geometry::TriangleSurface plate(const Vec3& size, int n) {
  geometry::TriangleSurface s;
  const int m = n + 1;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i)
        s.points.push_back(size.cwiseProduct(
            Vec3(static_cast<double>(i) / n, static_cast<double>(j) / n, k) - Vec3::Constant(0.5)));
  const auto at = [&](int i, int j, int k) { return (k * m + j) * m + i; };
  const auto quad = [&](int a, int b, int c, int d) {
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({a, c, d});
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      quad(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
      quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
    }
  for (int i = 0; i < n; ++i) {
    quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
    quad(at(i, n, 0), at(i, n, 1), at(i + 1, n, 1), at(i + 1, n, 0));
    quad(at(0, i, 0), at(0, i, 1), at(0, i + 1, 1), at(0, i + 1, 0));
    quad(at(n, i, 0), at(n, i + 1, 0), at(n, i + 1, 1), at(n, i, 1));
  }
  return s;
}

/// A drum about z whose corners lie on its rims.
inline geometry::TriangleSurface prism(double radius, double length, int sides) {
  geometry::TriangleSurface s;
  for (int k = 0; k < sides; ++k) {
    const double u = 2.0 * std::numbers::pi * k / sides;
    for (const double z : {-0.5 * length, 0.5 * length})
      s.points.emplace_back(radius * std::cos(u), radius * std::sin(u), z);
  }
  s.points.emplace_back(0.0, 0.0, -0.5 * length);
  s.points.emplace_back(0.0, 0.0, 0.5 * length);
  for (int k = 0; k < sides; ++k) {
    const int a = 2 * k, b = 2 * ((k + 1) % sides);
    s.triangles.push_back({a, b, b + 1});
    s.triangles.push_back({a, b + 1, a + 1});
    s.triangles.push_back({b, a, 2 * sides});
    s.triangles.push_back({a + 1, b + 1, 2 * sides + 1});
  }
  return s;
}

}  // namespace polhode::test
