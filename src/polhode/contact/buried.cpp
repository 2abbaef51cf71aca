// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <polhode/contact/buried.hpp>
#include <polhode/contact/nearest.hpp>

namespace polhode::contact {

namespace {

/// A place where the shape has material, in coordinates of its body.
Vec3 witness(const Shape& a) { return a.corners.empty() ? a.centre : a.corners.front(); }

/// The solid angle of a triangle seen from the origin, positive from behind (van Oosterom and
/// Strackee 1983).
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double p = a.norm(), q = b.norm(), r = c.norm();
  return 2.0 *
         std::atan2(a.dot(b.cross(c)), p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q);
}

/// Above or below a triangle, seen along z.
bool stands_over(const Vec3& y, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto side = [&](const Vec3& p, const Vec3& q) {
    return (q.x() - p.x()) * (y.y() - p.y()) - (q.y() - p.y()) * (y.x() - p.x());
  };
  return side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0;
}

}  // namespace

std::optional<Buried> buried(const Shape& a, const Shape& b, const Placement<double>& at_a,
                             const Placement<double>& at_b) {
  const Vec3 y = at_b.to_body(value(at_a.point(witness(a))));
  const bool bordered =
      std::any_of(b.edges.begin(), b.edges.end(), [](const Shape::Edge& e) { return e.open; });
  double around = 0.0, least = std::numeric_limits<double>::infinity();
  bool below = false;
  Vec3 out = Vec3::Zero();
  for (std::size_t t = 0; t < b.triangles.size(); ++t) {
    const Vec3 &p = b.corners[b.triangles[t][0]], &q = b.corners[b.triangles[t][1]],
               &r = b.corners[b.triangles[t][2]];
    if (bordered) {
      // A field of heights is free along the normals of its triangles.
      if (b.planes[t].normal.dot(y) < b.planes[t].offset) {
        Mat3 axes;
        axes.col(2) = b.axes.col(2);
        axes.col(0) = axes.col(2).unitOrthogonal();
        axes.col(1) = axes.col(2).cross(axes.col(0));
        const Mat3 to = axes.transpose();
        below = below || stands_over(to * y, to * p, to * q, to * r);
      }
    } else {
      around += solid_angle(p - y, q - y, r - y);
    }
    const Vec3 to = nearest_on_triangle(y, p, q, r).nearest - y;
    if (to.norm() < least) {
      least = to.norm();
      out = to;
    }
  }
  if (!(bordered ? below : around > 2.0 * std::numbers::pi)) return {};
  Buried found;
  found.depth = least + 2.0 * a.bound_radius + b.rounding;
  if (least > 0.0) found.normal = value(at_b.vector(out / least));
  return found;
}

}  // namespace polhode::contact
