// SPDX-License-Identifier: Apache-2.0
// Quadrature points of the contact potential between two meshes.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include <polhode/solids/mesh/shapes.hpp>
#include <polhode/surface_contact/edge_lines.hpp>
#include <polhode/surface_contact/mesh_surface.hpp>
#include <polhode/surface_contact/surface_points.hpp>

namespace polhode::surface_contact {

namespace {

using Point2 = Eigen::Vector2d;
using Polygon = std::vector<Point2>;

/// Largest distance of a corner from the plane of a flat face, over the face's size.
constexpr double kFlat = 1e-9;
/// Sine of the angle between normals up to which faces are parallel.
constexpr double kParallelNormals = 1e-6;
/// Largest distance of opposite faces, over the face's size.
constexpr double kNear = 0.1;
/// Area of an overlap, as a part of the face, below which it is rounding.
constexpr double kNothing = 1e-12;
/// Area of a face left for its nodes, as a part of it, below which it is rounding.
constexpr double kCovered = 1e-9;
/// Weights at the corners and in the middle of a triangle: exact for quadratic functions.
constexpr double kAtCorner = 1.0 / 12.0, kInMiddle = 0.75;
/// Weight halfway between the corners and the middle of a triangle: likewise exact.
constexpr double kHalfway = 1.0 / 3.0;

double cross(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }

double area(const Polygon& p) {
  double sum = 0.0;
  for (std::size_t k = 0; k + 2 < p.size(); ++k) sum += cross(p[k + 1] - p[0], p[k + 2] - p[0]);
  return 0.5 * sum;
}

double distance_to_segment(const Point2& p, const Point2& a, const Point2& b) {
  const double part = (p - a).dot(b - a) / (b - a).squaredNorm();
  return (p - a - std::clamp(part, 0.0, 1.0) * (b - a)).norm();
}

/// Part of a convex polygon left of the line from a to b (Sutherland and Hodgman 1974).
Polygon left_of(const Polygon& p, const Point2& a, const Point2& b) {
  Polygon kept;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Point2 &from = p[k], &to = p[(k + 1) % p.size()];
    const double d = cross(b - a, from - a), e = cross(b - a, to - a);
    if (d >= 0.0) kept.push_back(from);
    if ((d > 0.0 && e < 0.0) || (d < 0.0 && e > 0.0))
      kept.push_back(from + d / (d - e) * (to - from));
  }
  return kept;
}

/// A face with straight edges, in its own plane.
class FlatFace {
 public:
  FlatFace(const solids::CellShape& shape, std::span<const int> nodes, const std::vector<Vec3>& X)
      : shape_(shape), nodes_(nodes) {
    const auto corner = [&](std::size_t k) -> const Vec3& {
      return X[static_cast<std::size_t>(nodes[k])];
    };
    origin_ = corner(0);
    const Vec3 last = corner(nodes.size() - 1) - origin_;
    normal = (corner(1) - origin_).cross(last).normalized();
    axes_[0] = (corner(1) - origin_).normalized();
    axes_[1] = normal.cross(axes_[0]);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      outline.push_back(flat(corner(k)));
      size = std::max(size, (corner(k) - origin_).norm());
    }
    for (std::size_t k = 0; k < nodes.size(); ++k)
      is_flat = is_flat && std::abs(height(corner(k))) <= kFlat * size;
  }
  [[nodiscard]] Point2 flat(const Vec3& x) const {
    return {axes_[0].dot(x - origin_), axes_[1].dot(x - origin_)};
  }
  [[nodiscard]] double height(const Vec3& x) const { return normal.dot(x - origin_); }
  /// Shape functions at a point of the plane, by Newton's method.
  [[nodiscard]] Vec weights(const Point2& at) const {
    Vec3 xi = nodes_.size() == 3 ? Vec3(1.0 / 3.0, 1.0 / 3.0, 0.0) : Vec3(0.0, 0.0, 0.0);
    for (int k = 0; k < 20; ++k) {
      const Vec N = solids::shape_functions(shape_, xi);
      const Mat D = solids::shape_gradients(shape_, xi);
      Point2 rest = at;
      Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
      for (std::size_t a = 0; a < outline.size(); ++a) {
        const auto row = static_cast<Eigen::Index>(a);
        rest -= N[row] * outline[a];
        J.col(0) += D(row, 0) * outline[a];
        J.col(1) += D(row, 1) * outline[a];
      }
      const Point2 step = J.inverse() * rest;
      xi.head<2>() += step;
      if (step.norm() < 1e-14) break;
    }
    return solids::shape_functions(shape_, xi);
  }

  Vec3 normal;
  Polygon outline;
  double size = 0.0;
  bool is_flat = true;

 private:
  const solids::CellShape& shape_;
  std::span<const int> nodes_;
  Vec3 origin_;
  Vec3 axes_[2];
};

class PointMaker {
 public:
  PointMaker(const std::vector<Vec3>& X, const MeshSurface* other) : X_(X), other_(other) {
    if (!other) return;
    std::vector<double> x;
    for (const Vec3& node : X) x.insert(x.end(), node.begin(), node.end());
    for (const MeshPoint& v : other->vertices) vertices_.push_back(v.at(x.data()));
    const EdgeLines lines = sharp_edges(*other, X);
    const auto end = [&](int v) {
      return lines.vertices[static_cast<std::size_t>(v)].at(x.data());
    };
    for (const auto& edge : lines.edges) borders_.push_back({end(edge[0]), end(edge[1])});
  }

  void add(const std::string& where, const solids::LoadedFaces& block) {
    const solids::CellShape& shape = solids::cell_shape(block.shape);
    const auto n = static_cast<std::size_t>(shape.size());
    if (shape.order > 1) return add_points(surface_points(where, block, X_));
    for (std::size_t first = 0; first < block.nodes.size(); first += n) {
      const std::span<const int> own = std::span(block.nodes).subspan(first, n);
      const FlatFace face(shape, own, X_);
      covered_.assign(n, 0.0);
      if (other_ && face.is_flat) cut(face, own);
      const SurfacePoints all = surface_points(where, {block.shape, {own.begin(), own.end()}}, X_);
      double whole = 0.0;
      for (const SurfacePoints::Point& p : all.points) whole += p.area;
      for (std::size_t k = 0; k < all.points.size(); ++k) {
        const auto a =
            static_cast<std::size_t>(std::find(own.begin(), own.end(), all.nodes[k]) - own.begin());
        const double left = all.points[k].area - covered_[a];
        if (left > kCovered * whole) nodal_[all.nodes[k]] += left;
      }
    }
  }
  std::vector<MeshPoint> take() {
    for (const auto& [node, share] : nodal_) {
      MeshPoint p;
      p.add(node, 1.0);
      p.area = share;
      points_.push_back(p);
    }
    return std::move(points_);
  }

 private:
  void add_points(const SurfacePoints& s) {
    for (std::size_t k = 0; k < s.points.size(); ++k) {
      MeshPoint p;
      for (int a = 0; a < s.nodes_per_point; ++a)
        p.add(s.nodes[k * static_cast<std::size_t>(s.nodes_per_point) + a], s.points[k].N[a]);
      p.area = s.points[k].area;
      points_.push_back(p);
    }
  }

  /// Points inside of an overlap: of a triangle, or of those of a polygon with its middle.
  template <class Add>
  static void add_inside(const Polygon& cell, double least, Add&& add) {
    const auto of_triangle = [&](const Point2& a, const Point2& b, const Point2& c) {
      const double A = 0.5 * cross(b - a, c - a);
      if (!(A > least)) return;
      const Point2 middle = (a + b + c) / 3.0;
      for (const Point2& p : {a, b, c}) add(0.5 * (p + middle), kHalfway * A);
    };
    if (cell.size() == 3) return of_triangle(cell[0], cell[1], cell[2]);
    Point2 middle = Point2::Zero();
    for (const Point2& p : cell) middle += p / static_cast<double>(cell.size());
    for (std::size_t k = 0; k < cell.size(); ++k)
      of_triangle(cell[k], cell[(k + 1) % cell.size()], middle);
  }

  /// Sharp edges and borders of the other surface, in the plane of a face that they lie opposite
  /// to.
  [[nodiscard]] std::vector<std::array<Point2, 2>> borders(const FlatFace& face) const {
    std::vector<std::array<Point2, 2>> flat;
    for (const auto& [a, b] : borders_)
      if (std::max(std::abs(face.height(a)), std::abs(face.height(b))) <= kNear * face.size)
        flat.push_back({face.flat(a), face.flat(b)});
    return flat;
  }

  /// The overlaps of a face with the triangles opposite to it. A point exactly over the border of
  /// the other surface would have two ways, below it and beside it, and two stable equilibria.
  /// There all points are inside of the overlap, at the same places whatever corner is the first.
  void cut(const FlatFace& face, std::span<const int> own) {
    const double least = kNothing * std::abs(area(face.outline));
    std::vector<std::pair<Point2, double>> at;  // points of this face and their areas
    const auto add = [&](const Point2& p, double share) {
      for (auto& [q, sum] : at)
        if ((p - q).norm() < kFlat * face.size) {
          sum += share;
          return;
        }
      at.emplace_back(p, share);
    };
    const std::vector<std::array<Point2, 2>> borders = this->borders(face);
    const auto on_border = [&](const Point2& p) {
      return std::any_of(borders.begin(), borders.end(), [&](const auto& edge) {
        return distance_to_segment(p, edge[0], edge[1]) < kFlat * face.size;
      });
    };
    for (const auto& t : other_->triangles) {
      const auto corner = [&](int k) -> const Vec3& {
        return vertices_[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
      };
      const double h = face.height(corner(0));
      if (std::abs(h) > kNear * face.size) continue;
      const Vec3 n = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      if (n.dot(face.normal) > 0.0 || n.cross(face.normal).norm() > kParallelNormals) continue;
      Polygon cell = face.outline;
      // In the direction of the face's normal the triangle has the opposite orientation.
      for (int k = 3; k > 0 && !cell.empty(); --k)
        cell = left_of(cell, face.flat(corner(k % 3)), face.flat(corner(k - 1)));
      if (cell.size() < 3 || !(area(cell) > least)) continue;
      if (std::any_of(cell.begin(), cell.end(), on_border)) {
        add_inside(cell, least, add);
        continue;
      }
      for (std::size_t k = 1; k + 1 < cell.size(); ++k) {
        const double A = 0.5 * cross(cell[k] - cell[0], cell[k + 1] - cell[0]);
        if (!(A > least)) continue;
        for (const Point2& p : {cell[0], cell[k], cell[k + 1]}) add(p, kAtCorner * A);
        add((cell[0] + cell[k] + cell[k + 1]) / 3.0, kInMiddle * A);
      }
    }
    for (const auto& [p, share] : at) {
      const Vec N = face.weights(p);
      MeshPoint point;
      for (std::size_t a = 0; a < own.size(); ++a) {
        const double weight = N[static_cast<Eigen::Index>(a)];
        covered_[a] += share * weight;
        if (std::abs(weight) > 1e-14) point.add(own[a], weight);
      }
      point.area = share;
      points_.push_back(point);
    }
  }

  const std::vector<Vec3>& X_;
  const MeshSurface* other_;
  std::vector<Vec3> vertices_;
  std::vector<std::array<Vec3, 2>> borders_;
  std::vector<MeshPoint> points_;
  std::vector<double> covered_;  ///< By node of a face: its share of the covered area.
  std::map<int, double> nodal_;  ///< Remaining area by node.
};

}  // namespace

std::vector<MeshPoint> contact_points(const std::string& where,
                                      const std::vector<solids::LoadedFaces>& faces,
                                      const std::vector<Vec3>& X, const MeshSurface* other) {
  PointMaker maker(X, other);
  for (const solids::LoadedFaces& block : faces) maker.add(where, block);
  return maker.take();
}

}  // namespace polhode::surface_contact
