// SPDX-License-Identifier: Apache-2.0
// Contact points at an instant, with the derivatives of their directions: for equilibria and modes.
#include <algorithm>
#include <cmath>

#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/crossing_edges.hpp>
#include <polhode/contact/impulse_places.hpp>
#include <polhode/contact/point_weight.hpp>
#include <polhode/contact/surface_features.hpp>

namespace polhode::contact {

namespace {

/// Increment of central differences over surfaces of triangles: relative length and rotation. Their
/// error is its square, that of rounding 1e-16 over it.
constexpr double kInstantDifference = 1e-5;
/// Depth that keeps two bodies on their sides, as a part of the smaller half thickness.
constexpr double kSideDepth = 0.5;

/// Writes the derivatives of a vector by the twelve increments.
void put_derivatives(const V3<Dual>& x, double sign, ContactInstant::ByIncrements& by) {
  for (int j = 0; j < 12; ++j) by.col(j) << sign * x.x.d[j], sign * x.y.d[j], sign * x.z.d[j];
}

/// A body moved by one increment, in component j of (Δr, Δθ).
BodyStep nudged(BodyStep s, int j, double by) {
  if (!s.moves) return s;
  if (j < 3)
    s.r_n1[j] += by;
  else
    s.Lambda_n1 = cay(Vec3(by * Vec3::Unit(j - 3))) * s.Lambda_n1;
  return s;
}

}  // namespace

/// Appends the places of a corner or part over a surface of triangles, which has no closed form of
/// the derivatives.
void ContactSet::add_places_at(int point, const BodyStep& a, const BodyStep& b, ContactInstant made,
                               std::vector<ContactInstant>& list) const {
  const Point& p = points_[static_cast<std::size_t>(point)];
  const double reach = surface_reach(*p.data.a, *p.data.b) + 2.0 * std::max(0.0, p.gap_n);
  const auto at = [&](const BodyStep& x, const BodyStep& y) {
    return places_over_surface(point, 2.0 * reach, BothPlaced::at_end(x, y));
  };
  for (const Gap<double>& g : at(a, b)) {
    if (g.distance > reach) continue;
    made.gap = g.distance;
    made.normal = value(g.normal);
    made.place = value(g.point);
    made.normal_by.setZero();
    made.place_by.setZero();
    for (int j = 0; j < 12; ++j) {
      const int k = j % 6;
      const double h = kInstantDifference * (k < 3 ? p.data.length : 1.0);
      if (!(j < 6 ? a : b).moves) continue;
      Vec3 n[2], c[2];
      bool known = true;
      for (int side = 0; side < 2; ++side) {
        const double by = side == 0 ? -h : h;
        const auto places = at(j < 6 ? nudged(a, k, by) : a, j < 6 ? b : nudged(b, k, by));
        const Gap<double>* same = same_contact(places, made.normal);
        known = known && same;
        if (!same) break;
        n[side] = value(same->normal);
        c[side] = value(same->point);
      }
      if (!known) continue;
      made.normal_by.col(j) = (n[1] - n[0]) / (2.0 * h);
      made.place_by.col(j) = (c[1] - c[0]) / (2.0 * h);
    }
    list.push_back(made);
  }
}

/// @eq{statics-rows}
void ContactSet::points_at(std::span<const BodyStep> instants,
                           std::vector<ContactInstant>& list) const {
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    const Point& p = points_[static_cast<std::size_t>(i)];
    if (p.sensor) continue;
    const auto& balls = balls_[static_cast<std::size_t>(i)];
    const BodyStep &a = instants[static_cast<std::size_t>(balls.a)],
                   &b = instants[static_cast<std::size_t>(balls.b)];
    ContactInstant made;
    made.a = shapes_[static_cast<std::size_t>(p.a)].body;
    made.b = shapes_[static_cast<std::size_t>(p.b)].body;
    made.number = i;
    made.key = p.key;
    const FrictionLaw& f = p.data.friction;
    made.friction = f.mu;
    made.friction_across = f.mu_across > 0.0 ? f.mu_across : f.mu;
    made.static_friction = std::max(f.mu, f.mu_static);
    made.along = a.Lambda_n1 * f.direction;
    made.rolling = f.rolling;
    made.torsion = f.torsion;
    made.size = std::min(p.data.a->detail, p.data.b->detail);
    if (p.data.history.closed) {
      made.impulse = p.data.history.impulse;
      made.turning = p.data.history.turning;
    }
    made.slips = p.data.history.closed && p.data.history.slips;
    if (is_over_surface(p.data.pair.kind)) {
      add_places_at(i, a, b, made, list);
      continue;
    }
    const BothPlaced at = BothPlaced::at_end(a, b);
    const Gap<double> found = gap(p.data.pair, *p.data.a, *p.data.b, at.a, at.b);
    Gap<double> g = found;
    const bool of_edges =
        p.data.pair.kind == GapKind::edge_edge || p.data.pair.kind == GapKind::rim_edge;
    if (p.data.pair.kind == GapKind::edge_edge) {
      // Edges on the far sides of two bodies are behind each other, too, but not nearly.
      const std::optional<Crossing> c = crossing(p.data, at);
      const bool overlap = c && c->behind && c->gap.distance < made.size;
      if (!overlap && !(c && c->in_front)) continue;
    }
    if (of_edges && !correct_edges(p.data, at, g)) continue;
    if (!is_row_at(p.data, at.a, at.b)) continue;
    const Gap<Dual> with =
        gap(p.data.pair, *p.data.a, *p.data.b, Placement<Dual>(a.r_n1, a.Lambda_n1, 0),
            Placement<Dual>(b.r_n1, b.Lambda_n1, 6));
    made.gap = g.distance;
    made.normal = value(g.normal);
    made.place = value(g.point);
    const bool behind = made.normal.dot(value(found.normal)) < 0.0;
    put_derivatives(with.normal, behind ? -1.0 : 1.0, made.normal_by);
    put_derivatives(with.point, 1.0, made.place_by);
    list.push_back(made);
  }
}

/// Along its normal a pair of convex features approaches no faster than this, as a plane between
/// them remains one. @eq{contact-filter}
double ContactSet::part_on_one_side(std::span<const BodyStep> instants,
                                    std::span<const Vec6> increments) const {
  double part = 1.0;
  const Vec6 still = Vec6::Zero();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    const geometry::Shape &A = *p.data.a, &B = *p.data.b;
    if (p.sensor || !A.bounded() || !B.bounded()) continue;  // nothing passes a half space
    const auto of = [&](int body) -> const Vec6& {
      return static_cast<std::size_t>(body) + 1 == instants.size()
                 ? still
                 : increments[static_cast<std::size_t>(body)];
    };
    const Vec6 &x = of(balls_[i].a), &y = of(balls_[i].b);
    const double speed = std::max(0.0, -p.normal_n.dot(x.head<3>() - y.head<3>())) +
                         x.tail<3>().norm() * A.reach + y.tail<3>().norm() * B.reach;
    const bool surface = is_over_surface(p.data.pair.kind);
    const double depth =
        kSideDepth * (surface ? A.rounding + B.rounding : std::min(A.detail, B.detail));
    const double room = std::max(0.0, p.gap_n) + depth;
    if (speed * part > room) part = room / speed;
  }
  return part;
}

}  // namespace polhode::contact
