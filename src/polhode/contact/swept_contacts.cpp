// SPDX-License-Identifier: Apache-2.0
// Bodies that would pass through each other within a step whose rows hold at its end.
#include <algorithm>
#include <cmath>

#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/crossing_edges.hpp>
#include <polhode/contact/impulse_places.hpp>
#include <polhode/contact/point_weight.hpp>

namespace polhode::contact {

namespace {

/// Relative displacement in a step, as a part of the smaller half thickness, up to which no search
/// is made: bodies then overlap on the way by at most an eighth of its square of the thickness.
constexpr double kShortWay = 0.1;
/// Gap and overlap, as a part of the smaller half thickness, between which surfaces are near each
/// other; and the ratio of the ways beyond the first near place at which overlaps are looked for.
constexpr double kNear = 1e-3, kFarther = 1.5;
/// Most advances of a search. Points that roll at a small gap need many, and do not pass.
constexpr int kMostAdvances = 64;

/// A body at a part of its step, as if the step ended there.
BodyStep at_part(const BodyStep& s, double part) {
  BodyStep at = s;
  if (!s.moves) return at;
  at.r_n1 = s.r_n + part * s.u;
  at.Lambda_n1 = cay(Vec3(part * s.theta)) * s.Lambda_n;
  return at;
}

/// Bound of the speed of a shape's points by the rotation of its body, per step.
double turning(const geometry::Shape& s, const BodyStep& step) {
  return step.theta.norm() * (s.solid == geometry::Solid::ball ? s.centre.norm() : s.reach);
}

}  // namespace

/// Whether the features of a pair overlap at the ends of these steps, or have passed through each
/// other, if they are edges.
bool ContactSet::overlaps_at_end(const Point& p, const BodyStep& a, const BodyStep& b,
                                 double near) const {
  if (p.data.pair.kind == GapKind::edge_edge) return have_met(p.data, a, b);
  const BothPlaced at = BothPlaced::at_end(a, b);
  return gap(p.data.pair, *p.data.a, *p.data.b, at.a, at.b).distance < -near &&
         is_row_at(p.data, at.a, at.b);
}

/// Conservative advancement: along the normal of their gap two convex features approach no faster
/// than `contact-filter` allows, so that they do not meet before they have made up for the gap.
/// (B. Mirtich, Impulse-based dynamic simulation of rigid body systems, 1996.) Beyond the first
/// place where they are near, those that slide or roll along each other do not overlap.
/// @eq{contact-filter}
bool ContactSet::meets_on_the_way(int point, const BodyStep& a, const BodyStep& b,
                                  double way) const {
  const Point& p = points_[static_cast<std::size_t>(point)];
  const geometry::Shape &A = *p.data.a, &B = *p.data.b;
  const double near = kNear * std::min(A.detail, B.detail), turns = turning(A, a) + turning(B, b);
  double gap_now = p.gap_n, part = 0.0;
  Vec3 n = p.normal_n;
  for (int k = 0; gap_now > near; ++k) {
    const double speed = std::max(0.0, -n.dot(a.u - b.u)) + turns;
    if (k == kMostAdvances || !(gap_now < speed * (1.0 - part))) return false;
    part += gap_now / speed;
    const BodyStep there_a = at_part(a, part), there_b = at_part(b, part);
    const BothPlaced at = BothPlaced::at_end(there_a, there_b);
    const Gap<double> g = gap(p.data.pair, A, B, at.a, at.b);
    gap_now = g.distance;
    n = value(g.normal);
  }
  for (double more = near / way; part + more < 1.0; more *= kFarther)
    if (overlaps_at_end(p, at_part(a, part + more), at_part(b, part + more), near)) return true;
  return false;
}

std::optional<std::pair<int, int>> ContactSet::passing(std::span<const BodyStep> steps) const {
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    const Point& p = points_[static_cast<std::size_t>(i)];
    const geometry::Shape &A = *p.data.a, &B = *p.data.b;
    if (p.sensor || !A.bounded() || !B.bounded() || p.gap_n <= touching_gap()) continue;
    const auto at = static_cast<std::size_t>(i);
    const BodyStep &a = steps[static_cast<std::size_t>(balls_[at].a)],
                   &b = steps[static_cast<std::size_t>(balls_[at].b)];
    const double way = (a.u - b.u).norm() + turning(A, a) + turning(B, b);
    if (way < p.gap_n || way < kShortWay * std::min(A.detail, B.detail)) continue;
    // At the end a row holds it, or it is seen to overlap.
    if (nearest_at_end(i, steps) <= touching_gap()) continue;
    if (meets_on_the_way(i, a, b, way)) return std::pair(shapes_[p.a].body, shapes_[p.b].body);
  }
  return std::nullopt;
}

}  // namespace polhode::contact
