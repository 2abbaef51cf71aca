// SPDX-License-Identifier: Apache-2.0
#include <polhode/contact/crossing_edges.hpp>
#include <polhode/contact/mouth_rim.hpp>

namespace polhode::contact {

namespace {

/// Angle by which a direction may lie outside a cone of normals: that of faces that lie on each
/// other to the accuracy of rows.
constexpr double kFlush = 1e-6;

/// An edge in the world.
struct PlacedEdge {
  Vec3 from, along, out;

  PlacedEdge(const geometry::Shape& s, const geometry::Shape::Edge& e, const Placement<double>& at)
      : from(value(at.point(s.corners[e.i]))),
        along(value(at.between(s.corners[e.i], s.corners[e.j]))),
        out(value(at.vector(e.out))) {}

  /// Whether a point near the edge is between its ends.
  [[nodiscard]] bool beside(const Vec3& x) const {
    const double t = (x - from).dot(along) / along.squaredNorm();
    return t > 0.0 && t < 1.0;
  }
};

/// The edges of a pair.
struct PlacedEdges {
  PlacedEdge a, b;

  PlacedEdges(const PointData& d, const BothPlaced& at)
      : a(*d.a, d.a->edges[d.pair.i], at.a), b(*d.b, d.b->edges[d.pair.j], at.b) {}
  /// Six times the volume of the tetrahedron of both; its sign changes where they meet.
  [[nodiscard]] double volume() const { return (a.from - b.from).dot(a.along.cross(b.along)); }
};

}  // namespace

bool correct_edges(const PointData& d, const BothPlaced& at, Gap<double>& g) {
  const PlacedEdge f(*d.b, d.b->edges[d.pair.j], at.b);
  const Vec3 n = value(g.normal), c = value(g.point);
  if (!f.beside(c)) return false;
  Vec3 out;
  if (d.pair.kind == GapKind::rim_edge) {
    out = value(at.a.vector(out_of_rim(*d.a, at.a.to_body(c))));
  } else {
    const PlacedEdge e(*d.a, d.a->edges[d.pair.i], at.a);
    if (!e.beside(c)) return false;
    out = e.out;
  }
  if (n.dot(f.out - out) >= 0.0) return true;
  g.distance = -g.distance - 2.0 * (d.a->rounding + d.b->rounding);
  g.normal = -1.0 * g.normal;
  return true;
}

std::optional<Crossing> crossing(const PointData& d, const BothPlaced& at) {
  const PlacedEdges edges(d, at);
  Crossing found;
  found.gap = gap(d.pair, *d.a, *d.b, at.a, at.b);
  const Vec3 c = value(found.gap.point), n = value(found.gap.normal);
  if (!edges.a.beside(c) || !edges.b.beside(c)) return std::nullopt;
  const double on_a = -n.dot(edges.a.out), on_b = n.dot(edges.b.out),
               of_a = d.a->edges[d.pair.i].cone - kFlush, of_b = d.b->edges[d.pair.j].cone - kFlush;
  found.in_front = on_a >= of_a && on_b >= of_b;
  found.behind = -on_a >= of_a && -on_b >= of_b;
  return found;
}

bool passed_through(const PointData& d, const BodyStep& a, const BodyStep& b) {
  return PlacedEdges(d, BothPlaced::at_start(a, b)).volume() *
             PlacedEdges(d, BothPlaced::at_end(a, b)).volume() <
         0.0;
}

bool have_met(const PointData& d, const BodyStep& a, const BodyStep& b) {
  const std::optional<Crossing> end = crossing(d, BothPlaced::at_end(a, b));
  return end && (end->gap.distance < 0.0 || (end->behind && passed_through(d, a, b)));
}

}  // namespace polhode::contact
