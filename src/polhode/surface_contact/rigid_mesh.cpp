// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <polhode/surface_contact/combined_gap.hpp>
#include <polhode/surface_contact/rigid_mesh.hpp>

namespace polhode::surface_contact {

namespace {

using geometry::TriangleRegion;
using geometry::TriangleTree;

/// Offset, as a part of the rounding, at which the nearest features of a point are determined.
/// Points of meshes often lie exactly over an edge or corner; with the offset neighbouring points
/// still agree on the features. The gap error is of second order in it.
constexpr double kAside = 1e-7;

Vec3 normal_on(const Vec3& from, double distance) {
  return distance > 0.0 ? Vec3(from / distance) : Vec3(Vec3::UnitZ());
}

}  // namespace

RigidMesh::RigidMesh(geometry::Shape surface)
    : surface_(std::move(surface)),
      tree_(surface_.corners, surface_.triangles),
      outward_(surface_.corners.size(), Vec3::Zero()) {
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    const auto& c = surface_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = surface_.corners[static_cast<std::size_t>(c[k])];
      const Vec3 u = surface_.corners[static_cast<std::size_t>(c[(k + 1) % 3])] - x;
      const Vec3 v = surface_.corners[static_cast<std::size_t>(c[(k + 2) % 3])] - x;
      const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
      outward_[static_cast<std::size_t>(c[k])] += angle * surface_.planes[t].normal;
    }
  }
  bordered_ = std::any_of(surface_.edges.begin(), surface_.edges.end(),
                          [](const geometry::Shape::Edge& e) { return e.open; });
}

/// Whether the point lies in the bounding box of the surface, or, for one with a border, which has
/// no lower side, below that.
bool RigidMesh::may_be_behind(const Vec3& y) const {
  const Vec3 low = tree_.low(), high = tree_.high();
  return (y.array() <= high.array()).all() &&
         (y.head<2>().array() >= low.head<2>().array()).all() && (bordered_ || y[2] >= low[2]);
}

/// Nearest point of the surface. Enclosed points have their nearest point at any distance.
geometry::TriangleTree::Hit RigidMesh::nearest(const Vec3& y, double at_most, bool sided) const {
  const bool any = sided && may_be_behind(y);
  return tree_.nearest(y, any ? std::numeric_limits<double>::infinity() : at_most);
}

RigidMesh::Feature RigidMesh::feature(int triangle, const geometry::TriangleRegion& region) const {
  const auto t = static_cast<std::size_t>(triangle), k = static_cast<std::size_t>(region.k);
  if (region.kind == geometry::TriangleRegion::face) return {region.kind, triangle, 0};
  if (region.kind == geometry::TriangleRegion::edge)
    return {region.kind, surface_.triangle_edges[t][k], 0};
  return {region.kind, surface_.triangles[t][k], 0};
}

/// Whether a point is behind the surface at its nearest point, by the normals of the triangles that
/// meet there: the sign of their sum weighted by angles decides for any point (Baerentzen, Aanaes
/// 2005). At a border nothing is behind.
bool RigidMesh::behind(const Vec3& y, const geometry::TriangleTree::Hit& hit) const {
  if (!may_be_behind(y)) return false;
  const Feature f = feature(hit.triangle, hit.region);
  const auto i = static_cast<std::size_t>(f.index);
  const Vec3 from = y - hit.region.nearest;
  switch (f.kind) {
    case geometry::TriangleRegion::face:
      return surface_.planes[i].normal.dot(y) < surface_.planes[i].offset;
    case geometry::TriangleRegion::edge:
      return !surface_.edges[i].open && surface_.edges[i].out.dot(from) < 0.0;
    case geometry::TriangleRegion::corner:
      return !surface_.border_corner[i] && outward_[i].dot(from) < 0.0;
  }
  return false;
}

double RigidMesh::extent() const {
  if (bordered_) return std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const Vec3& x : surface_.corners) most = std::max(most, x.norm());
  return most + surface_.rounding;
}

double RigidMesh::distance(const Vec3& y, double at_most, bool sided) const {
  const geometry::TriangleTree::Hit hit = nearest(y, at_most + surface_.rounding, sided);
  if (hit.triangle < 0) return at_most;
  const double signed_distance = sided && behind(y, hit) ? -hit.distance : hit.distance;
  return std::min(at_most, signed_distance - surface_.rounding);
}

/// Gap with a triangle, edge or corner as the core. @eq{surface-gap}
SurfaceGap RigidMesh::gap_of(const Feature& feature, const Vec3& y, double round) const {
  const auto i = static_cast<std::size_t>(feature.index);
  if (feature.kind == geometry::TriangleRegion::face) {
    const geometry::Shape::Plane& plane = surface_.planes[i];
    const double height = plane.normal.dot(y) - plane.offset;
    const double side = height < 0.0 ? -1.0 : 1.0;
    return {side * height - round, side * plane.normal, Mat3::Zero()};
  }
  Vec3 from;
  Mat3 fixed = Mat3::Identity();  // I without the directions that the nearest point follows
  if (feature.kind == geometry::TriangleRegion::edge) {
    const geometry::Shape::Edge& edge = surface_.edges[i];
    const Vec3& p = surface_.corners[static_cast<std::size_t>(edge.i)];
    const Vec3 along = (surface_.corners[static_cast<std::size_t>(edge.j)] - p).normalized();
    from = y - p;
    from -= along.dot(from) * along;
    fixed -= along * along.transpose();
  } else {
    from = y - surface_.corners[i];
  }
  const double d = from.norm();
  const Vec3 n = normal_on(from, d);
  if (!(d > 0.0)) return {-round, n, Mat3::Zero()};
  return {d - round, n, (fixed - n * n.transpose()) / d};
}

/// Multiplicities of the features near a point. Every triangle, edge and corner counts at its
/// nearest point, and most cancel.
RigidMesh::Features RigidMesh::features_near(const Vec3& point, double distance) const {
  const Vec3 y = point + kAside * surface_.rounding * Vec3(0.618, -0.325, 0.716);
  Features list;
  const auto count = [&](const Feature& f, int weight) {
    for (Feature& known : list)
      if (known.kind == f.kind && known.index == f.index) {
        known.count += weight;
        return;
      }
    list.push_back({f.kind, f.index, weight});
  };
  std::vector<int> edges, corners;
  for (const int t : tree_.near(y, distance)) {
    const auto& c = surface_.triangles[static_cast<std::size_t>(t)];
    const auto corner = [&](int k) -> const Vec3& {
      return surface_.corners[static_cast<std::size_t>(k)];
    };
    const geometry::TriangleRegion region =
        geometry::nearest_on_triangle(y, corner(c[0]), corner(c[1]), corner(c[2]));
    count(feature(t, region), 1);
    for (const int e : surface_.triangle_edges[static_cast<std::size_t>(t)]) edges.push_back(e);
    corners.insert(corners.end(), c.begin(), c.end());
  }
  for (std::vector<int>* indices : {&edges, &corners}) {
    std::sort(indices->begin(), indices->end());
    indices->erase(std::unique(indices->begin(), indices->end()), indices->end());
  }
  for (const int e : edges) {
    const geometry::Shape::Edge& edge = surface_.edges[static_cast<std::size_t>(e)];
    if (edge.open) continue;
    const Vec3& p = surface_.corners[static_cast<std::size_t>(edge.i)];
    const Vec3 v = surface_.corners[static_cast<std::size_t>(edge.j)] - p;
    const double t = (y - p).dot(v) / v.squaredNorm();
    if (t > 0.0 && t < 1.0)
      count({geometry::TriangleRegion::edge, e, 0}, -1);
    else
      count({geometry::TriangleRegion::corner, t > 0.0 ? edge.j : edge.i, 0}, -1);
  }
  for (const int c : corners)
    if (!surface_.border_corner[static_cast<std::size_t>(c)])
      count({geometry::TriangleRegion::corner, c, 0}, 1);
  return list;
}

SurfaceGap RigidMesh::sum(const Vec3& y, const SurfaceGap& nearest,
                          const GapQuery& question) const {
  const contact::NormalLaw& law = question.law;
  const double round = surface_.rounding + question.radius;
  std::vector<std::pair<SurfaceGap, int>> near;
  for (const Feature& f : features_near(y, law.reach() + round)) {
    if (f.count == 0) continue;
    const SurfaceGap g = gap_of(f, y, round);
    if (g.value < law.reach()) near.emplace_back(g, f.count);
  }
  if (near.empty()) return {law.reach(), nearest.normal, nearest.curvature};
  return combined_gap(law, near, nearest);
}

SurfaceGap RigidMesh::gap(const Vec3& y, const GapQuery& question) const {
  const double round = surface_.rounding + question.radius;
  const geometry::TriangleTree::Hit hit = nearest(y, question.at_most + round, question.sided);
  if (hit.triangle < 0) return {question.at_most, Vec3::UnitZ(), Mat3::Zero()};
  SurfaceGap g = gap_of(feature(hit.triangle, hit.region), y, round);
  if (question.sided && behind(y, hit)) {
    g.value = -(g.value + round) - round;
    g.normal = -g.normal;
    g.curvature = -g.curvature;
    return g;
  }
  const contact::NormalLaw& law = question.law;
  const double deep = law.floor() + kDeepInRigid * 2.0 * law.tolerance;
  if (!(g.value < law.reach()) || g.value < deep) return g;
  return sum(y, g, question);
}

}  // namespace polhode::surface_contact
