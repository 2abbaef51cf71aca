// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <polhode/compile/contact_shapes.hpp>
#include <polhode/contact/feature_pairs.hpp>
#include <polhode/contact/round_solids/cone.hpp>
#include <polhode/contact/round_solids/cylinder.hpp>
#include <polhode/contact/round_solids/ellipsoid.hpp>
#include <polhode/contact/tube.hpp>
#include <polhode/geometry/shapes.hpp>

#include "support/random_steps.hpp"
#include "support/shape_sizes.hpp"

namespace polhode::test {

struct NamedShape {
  std::string name;
  geometry::Shape shape;
};

/// A ring of n × 8 quadrilaterals, split in triangles: closed and not convex.
inline geometry::TriangleSurface torus(double R, double r, int n = 12) {
  geometry::TriangleSurface s;
  const int m = 8;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double u = 2.0 * std::numbers::pi * i / n, v = 2.0 * std::numbers::pi * j / m;
      s.points.push_back({(R + r * std::cos(v)) * std::cos(u), (R + r * std::cos(v)) * std::sin(u),
                          r * std::sin(v)});
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * m + j, b = ((i + 1) % n) * m + j, c = ((i + 1) % n) * m + (j + 1) % m,
                d = i * m + (j + 1) % m;
      s.triangles.push_back({a, b, c});
      s.triangles.push_back({a, c, d});
    }
  return s;
}

/// Corners of a body with 20 random points on an ellipsoid.
inline std::vector<Vec3> stone(unsigned seed) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < 20; ++i)
    points.push_back(random.direction().cwiseProduct(Vec3(0.5, 0.4, 0.3)));
  return points;
}

/// Diameters and length of a tube, with the flat sides that represent it for edges and faces.
inline geometry::Shape round_tube(double outer, double inner, double length,
                                  const geometry::ShapePlace& place = {}) {
  const std::vector<double> sizes{outer, inner, length};
  return contact::tube("tube", outer, inner, length,
                       geometry::shape_surface(*geometry::find_shape_kind("tube"), sizes, 48),
                       place);
}

/// One shape of every kind, about a metre in size, off the body's centre. Kinds without an entry
/// here follow those that have one.
inline std::vector<NamedShape> make_every_shape() {
  using namespace contact;
  const geometry::ShapePlace place{{0.05, -0.03, 0.02}, Random(3).frame()};
  std::vector<double> heights;
  for (int i = 0; i < 36; ++i) heights.push_back(0.1 * std::sin(1.3 * i) * std::cos(0.7 * i));
  std::vector<NamedShape> all{
      {"sphere", geometry::sphere("sphere", 0.8, place)},
      {"capsule", geometry::capsule("capsule", 0.4, 0.8, place)},
      {"box", geometry::box("box", {0.8, 0.7, 0.5}, place)},
      {"cylinder", cylinder("cylinder", 0.7, 0.9, place)},
      {"cone", cone("cone", 0.8, 0.9, place)},
      {"ellipsoid", ellipsoid("ellipsoid", {0.9, 0.7, 0.5}, place)},
      {"hull", geometry::hull("hull", stone(5), place)},
      {"mesh", geometry::mesh("mesh", torus(0.35, 0.15), place)},
      {"height_field", geometry::height_field("height_field", 6, 0.3, heights, place)},
      {"plane", geometry::plane(place)},
      {"tube", round_tube(0.8, 0.5, 0.7, place)}};
  for (const geometry::ShapeKind& kind : geometry::shape_kinds()) {
    if (std::any_of(all.begin(), all.end(), [&](const auto& s) { return s.name == kind.name; }))
      continue;
    ShapeSpec spec;
    spec.type = kind.name;
    spec.sizes = fitting_sizes(kind, {0.8, 0.9, 0.6});
    all.push_back({kind.name, contact_shape(kind.name, place, spec)});
  }
  return all;
}

/// One shape of every kind, made once in a process: tests are named after them at every start.
inline const std::vector<NamedShape>& every_shape() {
  static const std::vector<NamedShape> all = make_every_shape();
  return all;
}

}  // namespace polhode::test
