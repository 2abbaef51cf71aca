// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/hull.hpp>

namespace polhode::geometry {

namespace {

/// Distance, as a part of the size, below which a point is on the hull.
constexpr double kOnHull = 1e-10;

struct Face {
  std::array<int, 3> corners;
  Vec3 normal;
  double offset;
};

Face make_face(std::span<const Vec3> p, int a, int b, int c) {
  const Vec3 n = (p[b] - p[a]).cross(p[c] - p[a]).normalized();
  return {{a, b, c}, n, n.dot(p[a])};
}

/// Index of the point with the largest measure, the first of equals.
template <class Measure>
int farthest(std::span<const Vec3> points, Measure&& measure) {
  int best = 0;
  for (int i = 1; i < static_cast<int>(points.size()); ++i)
    if (measure(points[i]) > measure(points[best])) best = i;
  return best;
}

[[noreturn]] void refuse(std::string_view where, std::string_view shape) {
  throw InputError(where, format("the points lie {}, so their hull has no volume", shape),
                   "Give at least four points that do not lie in one plane");
}

std::vector<Face> first_tetrahedron(std::string_view where, std::span<const Vec3> p, double size) {
  const int a = 0;
  const int b = farthest(p, [&](const Vec3& x) { return (x - p[a]).squaredNorm(); });
  const Vec3 line = (p[b] - p[a]).normalized();
  const int c = farthest(p, [&](const Vec3& x) { return (x - p[a]).cross(line).squaredNorm(); });
  if ((p[c] - p[a]).cross(line).norm() < kOnHull * size) refuse(where, "on a line");
  const Vec3 normal = (p[b] - p[a]).cross(p[c] - p[a]).normalized();
  const int d = farthest(p, [&](const Vec3& x) { return std::abs(normal.dot(x - p[a])); });
  const double height = normal.dot(p[d] - p[a]);
  if (std::abs(height) < kOnHull * size) refuse(where, "in a plane");
  const int u = height > 0.0 ? c : b, v = height > 0.0 ? b : c;  // base faces away from d
  return {make_face(p, a, u, v), make_face(p, a, v, d), make_face(p, v, u, d),
          make_face(p, u, a, d)};
}

}  // namespace

TriangleSurface convex_hull(std::string_view where, std::span<const Vec3> points) {
  for (const Vec3& x : points)
    if (!x.allFinite())
      throw InputError(where, "a point of the hull is not finite", "Correct its coordinates");
  if (points.size() < 4)
    throw InputError(where, format("{} points have no hull with a volume", points.size()),
                     "Give at least four points that do not lie in one plane");
  const int far = farthest(points, [&](const Vec3& x) { return (x - points[0]).squaredNorm(); });
  const double size = (points[far] - points[0]).norm();
  if (!(size > 0.0)) refuse(where, "in one place");

  std::vector<Face> faces = first_tetrahedron(where, points, size);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const auto is_below = [&](const Face& f) {
      return f.normal.dot(points[i]) - f.offset <= kOnHull * size;
    };
    if (std::all_of(faces.begin(), faces.end(), is_below)) continue;
    std::vector<Face> kept;
    // directed edges of the faces visible from the point
    std::map<std::pair<int, int>, int> border;
    for (const Face& f : faces) {
      if (is_below(f)) {
        kept.push_back(f);
        continue;
      }
      for (int k = 0; k < 3; ++k) ++border[{f.corners[k], f.corners[(k + 1) % 3]}];
    }
    for (const auto& [edge, count] : border)
      if (!border.contains({edge.second, edge.first}))
        kept.push_back(make_face(points, edge.first, edge.second, i));
    faces = std::move(kept);
  }

  TriangleSurface hull;
  std::map<int, int> place;
  for (const Face& f : faces) {
    std::array<int, 3> corners{};
    for (int k = 0; k < 3; ++k) {
      const auto [at, fresh] =
          place.try_emplace(f.corners[k], static_cast<int>(hull.points.size()));
      if (fresh) hull.points.push_back(points[f.corners[k]]);
      corners[k] = at->second;
    }
    hull.triangles.push_back(corners);
  }
  return hull;
}

}  // namespace polhode::geometry
