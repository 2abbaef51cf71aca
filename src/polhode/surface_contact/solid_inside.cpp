// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <polhode/surface_contact/solid_inside.hpp>

namespace polhode::surface_contact {

namespace {

/// Smallest overlap, as a part of the longest edge of a triangle; see overlap().
constexpr double kLess = 0.1;
/// Distance outside a face at which another part of the solid is searched for, in the same unit.
constexpr double kAbove = 1e-6;

std::vector<Vec3> places(const std::vector<MeshPoint>& vertices, const double* x) {
  std::vector<Vec3> list;
  list.reserve(vertices.size());
  for (const MeshPoint& v : vertices) list.push_back(v.at(x));
  return list;
}

double longest_edge(const std::vector<Vec3>& x, const std::array<int, 3>& t) {
  const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(t[k])]; };
  return std::max({(at(1) - at(0)).norm(), (at(2) - at(1)).norm(), (at(0) - at(2)).norm()});
}

}  // namespace

SolidInside::SolidInside(const MeshSurface& boundary, const double* x)
    : corners_(places(boundary.vertices, x)),
      triangles_(boundary.triangles),
      tree_(corners_, triangles_) {}

std::optional<SurfaceOverlap> SolidInside::overlap(const Vec3& centre, double radius) const {
  const Vec3 beyond = (tree_.low() - centre).cwiseMax(centre - tree_.high());
  if (beyond.maxCoeff() > radius) return {};
  const bool within = tree_.winding(centre) > 0;
  const geometry::TriangleTree::Hit hit =
      tree_.nearest(centre, within ? std::numeric_limits<double>::infinity() : radius);
  if (hit.triangle < 0) return {};
  SurfaceOverlap found;
  found.depth = radius + (within ? hit.distance : -hit.distance);
  const std::array<int, 3>& t = triangles_[static_cast<std::size_t>(hit.triangle)];
  if (found.depth <= kLess * longest_edge(corners_, t)) return {};
  if (hit.distance > 0.0)
    found.out = (within ? 1.0 : -1.0) / hit.distance * (hit.region.nearest - centre);
  return found;
}

/// Distance to triangles without a common corner with this one.
double SolidInside::distance_to_others(const Vec3& x, const std::array<int, 3>& face) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : triangles_) {
    if (std::find_first_of(t.begin(), t.end(), face.begin(), face.end()) != t.end()) continue;
    const auto at = [&](std::size_t k) { return corners_[static_cast<std::size_t>(t[k])]; };
    const Vec3 nearest = geometry::nearest_on_triangle(x, at(0), at(1), at(2)).nearest;
    least = std::min(least, (x - nearest).norm());
  }
  return least;
}

std::optional<SurfaceOverlap> SolidInside::overlap_with_itself() const {
  std::optional<SurfaceOverlap> deepest;
  for (const auto& t : triangles_) {
    const auto at = [&](std::size_t k) { return corners_[static_cast<std::size_t>(t[k])]; };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    const double edge = longest_edge(corners_, t);
    const Vec3 above = (at(0) + at(1) + at(2)) / 3.0 + kAbove * edge * normal;
    if (tree_.winding(above) <= 0) continue;
    const double depth = distance_to_others(above, t);
    if (depth > kLess * edge && (!deepest || depth > deepest->depth)) deepest = {.depth = depth};
  }
  return deepest;
}

double SolidInside::size() const {
  std::vector<double> lengths;
  lengths.reserve(triangles_.size());
  for (const auto& t : triangles_) lengths.push_back(longest_edge(corners_, t));
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace polhode::surface_contact
