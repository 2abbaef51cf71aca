// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Eigenvalues>

#include <polhode/geometry/polyhedron.hpp>

namespace polhode::geometry {

namespace {

/// Sine of the angle between normals below which two faces lie in one plane: an edge between them
/// protrudes by less than a tenth of the rounding of a mesh. Such edges occur in files of single
/// precision.
constexpr double kFlatEdge = 1e-4;

Vec3 normal_of(const TriangleSurface& s, const std::array<int, 3>& t) {
  return (s.points[t[1]] - s.points[t[0]]).cross(s.points[t[2]] - s.points[t[0]]).normalized();
}

}  // namespace

TriangleSurface shrunk(const TriangleSurface& surface, double depth) {
  const std::size_t n = surface.points.size();
  std::vector<Mat3> normals(n, Mat3::Zero());
  std::vector<Vec3> wanted(n, Vec3::Zero());
  for (const auto& t : surface.triangles) {
    const Vec3 normal = normal_of(surface, t);
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = (surface.points[t[(k + 1) % 3]] - surface.points[t[k]]).normalized();
      const Vec3 v = (surface.points[t[(k + 2) % 3]] - surface.points[t[k]]).normalized();
      const double angle = std::acos(std::clamp(u.dot(v), -1.0, 1.0));
      normals[t[k]] += angle * normal * normal.transpose();
      wanted[t[k]] -= angle * depth * normal;
    }
  }
  TriangleSurface result = surface;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::SelfAdjointEigenSolver<Mat3> e(normals[i]);
    for (int k = 0; k < 3; ++k) {
      if (e.eigenvalues()[k] < 1e-4 * e.eigenvalues()[2])
        continue;  // nearly one plane: no displacement along it
      const Vec3 axis = e.eigenvectors().col(k);
      result.points[i] += axis.dot(wanted[i]) / e.eigenvalues()[k] * axis;
    }
  }
  return result;
}

void take_triangles(Shape& shape, const TriangleSurface& surface) {
  shape.corners = surface.points;
  shape.triangles = surface.triangles;
  struct Sides {
    int first = -1, second = -1;
  };
  std::map<std::pair<int, int>, Sides> sides;
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int i = surface.triangles[t][k], j = surface.triangles[t][(k + 1) % 3];
      Sides& s = sides[{std::min(i, j), std::max(i, j)}];
      (s.first < 0 ? s.first : s.second) = t;
    }
  for (const auto& t : surface.triangles) {
    const Vec3 n = normal_of(surface, t);
    shape.planes.push_back({n, n.dot(surface.points[t[0]])});
  }
  shape.border_corner.assign(surface.points.size(), 0);
  shape.triangle_edges.assign(surface.triangles.size(), {-1, -1, -1});
  for (const auto& [corners, s] : sides) {
    Shape::Edge e;
    e.i = corners.first;
    e.j = corners.second;
    const Vec3 n_1 = shape.planes[s.first].normal;
    if (s.second < 0) {
      e.open = true;
      shape.border_corner[e.i] = shape.border_corner[e.j] = 1;
      e.out = n_1;
    } else {
      const Vec3 n_2 = shape.planes[s.second].normal;
      e.out = (n_1 + n_2).normalized();
      e.cone = n_1.dot(e.out);
      // Convex if the second triangle lies below the plane of the first.
      Vec3 inside_2 = Vec3::Zero();
      for (int k : surface.triangles[s.second]) inside_2 += surface.points[k] / 3.0;
      const double height = n_1.dot(inside_2 - surface.points[e.i]);
      e.flat = n_1.cross(n_2).norm() < kFlatEdge && n_1.dot(n_2) > 0.0;
      e.convex = !e.flat && height < 0.0;
    }
    for (int t : {s.first, s.second}) {
      if (t < 0) continue;
      for (int k = 0; k < 3; ++k)
        if (std::minmax(surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]) ==
            std::minmax(e.i, e.j))
          shape.triangle_edges[t][k] = static_cast<int>(shape.edges.size());
    }
    shape.edges.push_back(e);
  }
}

void take_convex_corners(Shape& shape) {
  std::vector<bool> meets(shape.corners.size(), false);
  for (const Shape::Edge& e : shape.edges)
    if (e.convex) meets[e.i] = meets[e.j] = true;
  for (int i = 0; i < static_cast<int>(meets.size()); ++i)
    if (meets[i]) shape.points.push_back(i);
  shape.face_points = shape.points;
}

double inner_size(const TriangleSurface& hull) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& x : hull.points) mean += x / static_cast<double>(hull.points.size());
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : hull.triangles)
    least = std::min(least, normal_of(hull, t).dot(hull.points[t[0]] - mean));
  return least;
}

double median_edge(const TriangleSurface& surface) {
  std::vector<double> lengths;
  for (const auto& t : surface.triangles)
    for (int k = 0; k < 3; ++k)
      lengths.push_back((surface.points[t[k]] - surface.points[t[(k + 1) % 3]]).norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace polhode::geometry
