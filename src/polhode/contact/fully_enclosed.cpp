// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <polhode/contact/fully_enclosed.hpp>
#include <polhode/geometry/nearest.hpp>
#include <polhode/geometry/ray.hpp>

namespace polhode::contact {

namespace {

/// A point inside the shape, in coordinates of its body.
Vec3 witness(const geometry::Shape& a) { return a.corners.empty() ? a.centre : a.corners.front(); }

}  // namespace

std::optional<FullyEnclosed> fully_enclosed(const geometry::Shape& a, const geometry::Shape& b,
                                            const Placement<double>& at_a,
                                            const Placement<double>& at_b) {
  const Vec3 y = at_b.to_body(value(at_a.point(witness(a))));
  const bool bordered = std::any_of(b.edges.begin(), b.edges.end(),
                                    [](const geometry::Shape::Edge& e) { return e.open; });
  // A height field is open above: a point that sees it along the upward ray lies below it.
  const Vec3 ray = bordered ? Vec3(b.axes.col(2)) : geometry::kAnyRay;
  int around = 0;
  double least = std::numeric_limits<double>::infinity();
  Vec3 out = Vec3::Zero();
  for (const auto& t : b.triangles) {
    const Vec3 &p = b.corners[t[0]], &q = b.corners[t[1]], &r = b.corners[t[2]];
    around += geometry::crossing(ray, p - y, q - y, r - y);
    const Vec3 to = geometry::nearest_on_triangle(y, p, q, r).nearest - y;
    if (to.norm() < least) {
      least = to.norm();
      out = to;
    }
  }
  if (around <= 0) return {};
  FullyEnclosed found;
  found.depth = least + 2.0 * a.bound_radius + b.rounding;
  if (least > 0.0) found.normal = value(at_b.vector(out / least));
  return found;
}

}  // namespace polhode::contact
