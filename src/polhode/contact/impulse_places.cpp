// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/crossing_edges.hpp>
#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/impulse_places.hpp>
#include <polhode/contact/surface_features.hpp>

namespace polhode::contact {

/// Cosine of the angle between the normals of a contact with a surface at two instants of a step.
constexpr double kSameContact = 0.9;

const Gap<double>* same_contact(const std::vector<Gap<double>>& gaps, const Vec3& n) {
  const Gap<double>* best = nullptr;
  double most = kSameContact;
  for (const Gap<double>& g : gaps)
    if (const double y = value(g.normal).dot(n); y > most) most = y, best = &g;
  return best;
}

namespace {

/// The place at the end of a step of a contact at its start: each has, of all, the normal closest
/// to the other's; of several in one direction, as on both sides of a sheet, the nearest one.
const Gap<double>* end_of(const Vec3& normal, const Vec3& place,
                          const std::vector<Gap<double>>& at_start,
                          const std::vector<Gap<double>>& at_end) {
  const Gap<double>* end = same_contact(at_end, normal);
  const Gap<double>* start = end ? same_contact(at_start, value(end->normal)) : nullptr;
  return start && value(start->point) != place ? nullptr : end;
}

}  // namespace

/// Gaps of a corner or part at the places of a surface that are nearer than `reach`.
std::vector<Gap<double>> ContactSet::places_over_surface(int point, double reach,
                                                         const BothPlaced& at) const {
  const PointData& d = points_[point].data;
  std::vector<Gap<double>> gaps;
  if (d.pair.kind == GapKind::part_surface)
    part_gaps(part_of(*d.a, d.pair.i), reach, *d.b, at.a, at.b, gaps);
  else
    point_gaps(value(at.a.point(d.a->corners[d.pair.i])), d.a->rounding, reach, *d.b, at.b, gaps);
  return gaps;
}

/// Appends the places at which a corner or part touches a surface of triangles. Their number, and
/// the triangles that they lie on, may change in the step.
void ContactSet::find_places(int point, std::span<const BodyStep> steps, double dt, bool again,
                             std::vector<ImpulsePoint>& list) {
  const Point& p = points_[point];
  const BodyStep &a = steps[balls_[point].a], &b = steps[balls_[point].b];
  if (!again && 2.0 * least_gap_at_end(p, a, b) > p.gap_n) return;
  // Search radii: the way of two steps at the start; at the end only overlaps are needed.
  const double touch = surface_reach(*p.data.a, *p.data.b),
               way = p.gap_n - least_gap_at_end(p, a, b);
  PlacesAtStart& known = start_places_[point];
  if (!(known.reach >= touch + 2.0 * way)) {
    known.reach = touch + 2.0 * way;
    known.gaps = places_over_surface(point, known.reach, BothPlaced::at_start(a, b));
  }
  const std::vector<Gap<double>>& at_start = known.gaps;
  const auto at_end = places_over_surface(point, touch, BothPlaced::at_end(a, b));
  const auto listed = [&](const auto& is_same) {
    return std::any_of(list.begin(), list.end(),
                       [&](const ImpulsePoint& at) { return at.number == point && is_same(at); });
  };
  const auto leads_to = [&](const Gap<double>& end) {
    return [&](const Gap<double>& start) {
      return end_of(value(start.normal), value(start.point), at_start, at_end) == &end;
    };
  };
  bool stopped = false;
  const Gap<double>* pressed = nullptr;  // place of the impulse of the last step
  double most = -1.0;
  for (const Gap<double>& g : at_start)
    if (const double y = value(g.normal).dot(p.data.history.impulse); again && y > most)
      most = y, pressed = &g;
  for (const Gap<double>& g : at_start) {
    ImpulsePoint at = impulse_point(point, g, steps);
    const Gap<double>* end = end_of(at.normal, at.place, at_start, at_end);
    const bool rolls_in = end && end->distance < std::min(0.0, g.distance);
    if (&g != pressed && !rolls_in && !must_act(at, a, b, dt)) continue;
    if (listed([&](const ImpulsePoint& other) { return other.place_n == at.place_n; })) continue;
    if (&g == pressed) {
      at.impulse = p.data.history.impulse;
      at.turning = p.data.history.turning;
    }
    list.push_back(at);
    stopped = true;
  }
  // The end of the step is unknown without these impulses.
  if (stopped) return;
  for (const Gap<double>& g : at_end) {
    const Vec3 n = value(g.normal);
    if (g.distance >= 0.0 || std::any_of(at_start.begin(), at_start.end(), leads_to(g)) ||
        listed([&](const ImpulsePoint& at) {
          return end_of(at.normal_n, at.place_n, at_start, at_end) == &g;
        }))
      continue;
    const Vec3 place = value(g.point);
    const double parted = n.dot(apart(a, b, place));
    if (parted >= 0.0) continue;
    Gap<double> start = g;
    start.distance = g.distance - parted;
    start.point = constant<double>(Vec3(place - a.u));
    list.push_back(impulse_point(point, start, steps));
  }
}

/// Gap at the end of a step of a point of the list; none: it is in contact with a surface of
/// triangles that has no such place then.
std::optional<double> ContactSet::gap_at_end_of(const ImpulsePoint& at,
                                                std::span<const BodyStep> steps) const {
  const Point& p = points_[at.number];
  const BodyStep &a = steps[balls_[at.number].a], &b = steps[balls_[at.number].b];
  if (p.data.pair.kind == GapKind::rim_edge ||
      (p.data.pair.kind == GapKind::edge_edge && acts_by_rows())) {
    const BothPlaced end = BothPlaced::at_end(a, b);
    const Gap<double> g = gap(p.data.pair, *p.data.a, *p.data.b, end.a, end.b);
    // Behind each other the distance of the curves grows again.
    const bool passed = p.data.pair.kind == GapKind::edge_edge
                            ? passed_through(p.data, a, b) && crossing(p.data, end)
                            : value(g.normal).dot(at.normal_n) < 0.0;
    return passed ? -g.distance - 2.0 * (p.data.a->rounding + p.data.b->rounding) : g.distance;
  }
  if (!is_over_surface(p.data.pair.kind)) return gap_at_end(at.number, a, b);
  const double reach = surface_reach(*p.data.a, *p.data.b) + std::max(0.0, at.gap);
  const auto at_end = places_over_surface(at.number, reach, BothPlaced::at_end(a, b));
  const auto known = start_places_.find(at.number);
  const Gap<double>* same = known == start_places_.end()
                                ? same_contact(at_end, at.normal_n)
                                : end_of(at.normal_n, at.place_n, known->second.gaps, at_end);
  return same ? std::optional<double>(same->distance) : std::nullopt;
}

/// Gap at the end of a step; of several places on a surface that of the nearest, not that of all.
double ContactSet::nearest_at_end(int point, std::span<const BodyStep> steps) const {
  const Point& p = points_[point];
  const BodyStep &a = steps[balls_[point].a], &b = steps[balls_[point].b];
  const double all = gap_at_end(point, a, b);
  if (!is_over_surface(p.data.pair.kind) || all > surface_reach(*p.data.a, *p.data.b)) return all;
  const auto at_end =
      places_over_surface(point, surface_reach(*p.data.a, *p.data.b), BothPlaced::at_end(a, b));
  return at_end.empty() ? all : at_end.front().distance;
}

}  // namespace polhode::contact
